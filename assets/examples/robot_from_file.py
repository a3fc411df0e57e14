"""A robot from its URDF file: held back for a second, it waits; its motors stay below a limit."""

import onpath
from onpath.assets import asset_path

arm = onpath.robot(asset_path("robots/seven_axes.urdf"), tip="tip", pose={"joint5": 0.0})
print(arm.text, onpath.parameters(arm)["torque_limit"])
run = onpath.simulate(arm, "ellipse 0.05 0.03", hold=(1, 2), duration=4, torque_limit=40)
print(run)
