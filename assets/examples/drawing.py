"""A path from an SVG drawing, twice as small and about the middle of the workspace."""

from pathlib import Path

import onpath

path = onpath.path_from(Path(__file__).with_name("leaf.svg"), fit=0.1, centre=(0, 0.01))
check = onpath.check_path("two_link_arm", path)  # a notebook draws it, red where it fails
print(check)
if check.nearest is not None:
    run = onpath.simulate("two_link_arm", check.nearest, duration=4)
    print(run)
