"""What a push costs the simulation thread: each step of each lesson, sent to sixty labs.

`python -m tests.bench.push` prints the processor time, [s], of the dearest step and of the average
one. The teacher has looked at the step before, so that its loops are compiled.
"""

from __future__ import annotations

import sys
import time

from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course

LABS = 60


def main() -> None:
    """Print a line for each lesson."""
    course, cache = built_in_course()[0], LoopCache()
    looked, *labs = (Lab(cache, FIVE_BAR, course) for _ in range(1 + LABS))
    for name in course.lessons:
        spent = list[float]()
        for index in range(len(course.lesson(name, "en").steps)):
            TakeStep(name, index).apply(looked)
            begin = time.thread_time()
            for lab in labs:
                TakeStep(name, index).apply(lab)
            spent.append(time.thread_time() - begin)
        mean = sum(spent) / len(spent)
        dearest = spent.index(max(spent)) + 1
        sys.stdout.write(f"{name:34} {max(spent):.2f} at step {dearest}, {mean:.2f}\n")


if __name__ == "__main__":
    main()
