"""Writes arm.csv: a five-bar whose motors stick, coarse encoders, uneven rows, late torques."""

from pathlib import Path

import numpy as np

import onpath

sensors = {"encoder_counts": 5000, "control_rate": 500, "coulomb": 0.03, "stiction": 0.05}
settings = {"speed": 6, "speed_profile": "sine", "duration": 10}
run = onpath.simulate("five_bar", "clover", "trajectory_tracking", **settings, **sensors)
rng = np.random.default_rng(54)
t = np.cumsum(rng.uniform(0.002, 0.008, 1800)) + 0.1  # [s], 200 rows per second
rows = np.column_stack([np.interp(t, run.t, q) for q in run.q.T])
angles = np.floor(rows / (2 * np.pi / 5000) + 0.5) * 360 / 5000  # [°], as the encoders have them
ends = np.append(t, t[-1] + 0.005) - 0.0128  # torques reach the log 12.8 ms after they acted
sums = [np.interp(ends, run.t + 1e-3, each) for each in 1e-3 * np.cumsum(run.torque.T, axis=1)]
means = np.column_stack([np.diff(each) / np.diff(ends) for each in sums])  # from row to row [N m]
currents = means / 0.5 + rng.normal(scale=0.03, size=means.shape)  # [A]
names = "Zeit [ms];Achse 1 [°];Achse 2 [°];Strom 1 [A];Strom 2 [A]"
table = np.column_stack([1e3 * (t - t[0]), angles, currents])
form = "{:.1f};{:.3f};{:.3f};{:.4f};{:.4f}"
lines = [form.format(*row).replace(".", ",") for row in table]
Path("arm.csv").write_text("\n".join([names, *lines, ""]), encoding="utf-8")
print(f"arm.csv: {len(t)} rows")
