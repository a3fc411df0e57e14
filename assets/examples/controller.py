"""A controller for a plant that is elsewhere, here in MuJoCo: it ends where the lab ends."""

import mujoco
import numpy as np

import onpath
from onpath.assets import asset_path

file = asset_path("robots/planar_arm.urdf")
lab, controller = onpath.simulate(file, duration=2), onpath.controller(file)
model = mujoco.MjModel.from_xml_path(str(file))
model.opt.timestep, model.opt.integrator = 1e-3, mujoco.mjtIntegrator.mjINT_RK4
data = mujoco.MjData(model)
data.qpos[:] = lab.q[0]
for _ in lab.t[1:]:
    data.qfrc_applied[:] = controller.step(data.time, data.qpos, data.qvel)
    mujoco.mj_step(model, data)
print("farthest joint from the lab:", np.abs(data.qpos - lab.q[-1]).max(), "rad")
