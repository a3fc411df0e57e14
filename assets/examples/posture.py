"""Seven motors for three coordinates: without a posture an arm falls, but its tip stays."""

import onpath

for gain in (1, 0):
    gains = {"posture_stiffness": 100 * gain, "posture_damping": 20 * gain}
    run = onpath.simulate("seven_axes", "circle", **gains)
    print(f"{gains}: {1e3 * run.distance.max():.2f} mm from the path; {run}")
