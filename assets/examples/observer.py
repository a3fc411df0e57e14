"""A hand pulls for three seconds and lets go: an observer forgets it sooner than an integral."""

import onpath

for law in ("path_following", "disturbance_observer"):
    pull = (0.5, 3.5, (0.02, 0.0))  # from 0.5 to 3.5 s, to y = (20, 0) mm
    run = onpath.simulate(law=law, task="position", target=0.0, push=pull, duration=5)
    off = run.trajectory.distance > 0.0005
    after = run.trajectory.t[off][-1] - 3.5
    print(f"{law}: {after:.2f} s after the release within 0.5 mm of the path")
