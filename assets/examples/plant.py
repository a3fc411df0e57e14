"""An arm in MuJoCo that `onpath control udp://127.0.0.1:9000` drives; see app/plant/README.md."""

import argparse
import socket
import struct
import time
from pathlib import Path

import mujoco
import numpy as np

options = argparse.ArgumentParser()
options.add_argument("--port", type=int, default=9000)
options.add_argument("--rate", type=float, default=250.0, help="measurements in a second")
options.add_argument("--seconds", type=float, default=3600.0)
options.add_argument("--fast", action="store_true", help="as fast as torques come")
options.add_argument("--fault", default="", help="hesitate, die, lie, jump, twice, back, second")
options.add_argument("--pause", type=float, default=0.1, help="seconds for which it hesitates")
options.add_argument("--at", type=float, default=1.0, help="time of the fault, in seconds")
given = options.parse_args()
robot = Path(__file__).parents[1] / "robots" / "planar_arm.urdf"
model = mujoco.MjModel.from_xml_path(str(robot))
data = mujoco.MjData(model)
model.opt.timestep, model.opt.integrator = 1e-3, mujoco.mjtIntegrator.mjINT_RK4
data.qpos[:] = 0.6985, 1.031, 1.007
n, interval = model.nv, 1 / given.rate
link, stranger = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
link.connect(("127.0.0.1", given.port))
link.settimeout(1.0 if given.fast else 2 * interval)


def measurement(sequence: int, q: np.ndarray) -> bytes:
    """A datagram with time, positions and velocities."""
    return struct.pack(f"<4sId{2 * n}d", b"OPM1", sequence, data.time, *q, *data.qvel)


def torque(sequence: int) -> tuple[int, np.ndarray]:
    """Code and torques that answer a measurement; code -1: none came."""
    try:
        while True:
            _, answered, code, *torques = struct.unpack(f"<4sIq{n}d", link.recv(2048))
            if answered == sequence:
                return code, np.array(torques)
    except OSError:  # too late, or nobody is there
        return -1, np.zeros(n)


begin, code, answers = time.monotonic(), 0, 0
for sequence in range(round(given.seconds * given.rate)):
    now = given.fault.split(",") if data.time > given.at - 1e-9 else []
    q = data.qpos + (0.2 if "jump" in now else np.nan if "lie" in now else 0)
    if "hesitate" in now and code == 0:
        time.sleep(given.pause)
    if "die" in now:
        break
    link.send(measurement(sequence, q))
    if "twice" in now:
        link.send(measurement(sequence, q))
    if "back" in now:
        link.send(measurement(0, q))
    if "second" in now:
        stranger.sendto(measurement(sequence + 1, q), ("127.0.0.1", given.port))
    code, data.qfrc_applied[:] = torque(sequence)
    answers += code != -1
    while data.time < (sequence + 1) * interval - 1e-9:
        mujoco.mj_step(model, data)
        data.qvel[:] *= code != -1  # the brakes close
    if not given.fast:
        time.sleep(max(0.0, begin + data.time - time.monotonic()))
    if data.time > 1 and answers == 0:
        print(f"nobody answers at port {given.port}")
        break
print(f"{answers} answers in {data.time:.2f} s; last code {code}")
