"""Two points that wait for the robot: only one of them hurries after a pull."""

import onpath

for law in ("waiting_clock", "maneuvering"):
    run = onpath.simulate(law=law, push=(1.0, 2.0, (0.0, 0.08)), duration=4)
    rate = run.trajectory.fields["theta_rate"][2000:, 0]
    print(f"{law}: at most {rate.max():.1f} rad/s after the release")
