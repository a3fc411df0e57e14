"""Inertias and friction of an arm from its own log: German columns, uneven times, late torques."""

import tempfile
from pathlib import Path

import onpath

log = Path(__file__).with_name("arm.csv")
columns = {"t": "Zeit [ms]", "q1": "Achse 1 [°]", "q2": "Achse 2 [°]"}
columns |= {"tau1": "Strom 1 [A]", "tau2": "Strom 2 [A]"}
units = {"t": "ms", "q1": "deg", "q2": "deg", "tau1": 0.5, "tau2": 0.5}  # 0.5 N m for an ampere
result = onpath.identify("five_bar", log, columns=columns, units=units)
print(result)
result.plot(Path(tempfile.mkdtemp(), "residuals.png"))
