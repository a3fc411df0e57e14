"""As fast as 0.5 N m allow, by a clock and by the place: free, held and let go."""

import onpath

for law in ("time_optimal_tracking", "time_optimal_following"):
    run = onpath.simulate(law=law, duration=7, hold=(3, 5), torque_limit=0.5, at_limit="cut")
    t, off = run.trajectory.t, 1e3 * run.trajectory.distance
    free, held, after = off[(t > 1) & (t < 3)], off[(t > 3) & (t < 5)], off[t > 5]
    print(f"{law}: {free.max():.2f} mm off, {held.max():.1f} held, {after.max():.1f} after")
