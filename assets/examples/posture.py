"""Seven motors for three coordinates: without a posture an arm runs away, but its tip stays."""

import onpath
from onpath.assets import asset_path

pose = {"joint1": 0, "joint2": 0.35, "joint3": 0, "joint4": 1.45, "joint5": 0, "joint6": 1.34}
arm = onpath.robot(asset_path("robots/seven_axes.urdf"), pose=pose)
for gain in (1, 0):
    stiffness, damping = 100 * gain, 20 * gain
    run = onpath.simulate(arm, "circle", posture_stiffness=stiffness, posture_damping=damping)
    turned = abs(run.trajectory.fields["q"] - run.trajectory.fields["q"][0]).max()
    off = 1e3 * run.max_distance
    gains = f"{stiffness} 1/s² and {damping} 1/s"
    print(f"{gains}: a joint turns by {turned:.1f} rad, and the tip is {off:.2f} mm off")
