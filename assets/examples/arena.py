"""A custom law against path following: the same trials for both, and a page with the runs."""

from own_law import SlidingMode

import onpath

laws = [SlidingMode, "path_following"]
result = onpath.arena("five_bar", laws, only=True, rounds=1, html="arena.html", figures=False)
print(result)
for row in result.table:
    print(row["law"], row["at_limit"], row["force_N"], "N")
