"""Seven motors for three coordinates: without a posture an arm runs away, but its tip stays."""

import onpath

for stiffness, damping in ((100, 20), (0, 0)):
    run = onpath.simulate(
        "seven_axes", "circle", posture_stiffness=stiffness, posture_damping=damping
    )
    turned = abs(run.trajectory.fields["q"] - run.trajectory.fields["q"][0]).max()
    off = f"the tip is {1e3 * run.max_distance:.2f} mm off"
    print(f"{stiffness} 1/s² and {damping} 1/s: a joint turns by {turned:.1f} rad, and {off}")
