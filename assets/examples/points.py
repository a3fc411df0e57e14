"""A path from a table of points, as a spreadsheet with decimal commas saved it."""

from pathlib import Path

import onpath

path = onpath.path_from(Path(__file__).with_name("points.csv"))
print(path, f"up to {1e3 * path.deviation:.1f} mm from the lines between the points")
run = onpath.simulate("five_bar", path, hold=(1, 2), duration=4)
print(run)
