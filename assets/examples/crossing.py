"""Held back at the crossing of a figure of eight, no robot takes the other strand."""

import math

import onpath

for law in ("trajectory_tracking", "path_following", "waiting_clock"):
    held = {"hold": (0.2, 1.2), "hold_at": math.pi / 2}
    run = onpath.simulate(path="figure of eight", law=law, duration=3, **held)  # warns: it crosses
    print(run)
