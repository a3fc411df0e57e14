"""A path from G-code with its corners rounded, as a figure that needs no server."""

import tempfile
from pathlib import Path

import onpath

file = Path(__file__).with_name("slot.nc")
path = onpath.path_from(file, centre=(0, 0), corners="round", radius=0.014)
page = onpath.figure(path={"slot": path}).save(Path(tempfile.mkdtemp(), "slot.html"))
print(f"{path}, up to {1e3 * path.deviation:.1f} mm from the tool's; open {page}")
