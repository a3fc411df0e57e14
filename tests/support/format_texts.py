"""A lesson that uses what the format has for marks, starts, slow motion, answers and numbers."""

from __future__ import annotations

from tests.support.lesson_texts import LESSON

SCENE = """```scene
controls = ["K1", "hold"]
plot = ["phase", "torques"]
show = ["tube", "errors"]
start = { place = 0.5, across = 10.0, speed = 50.0, across_rate = -20.0, lead = 0.2 }
marks = [{ at = [0, 50], text = "top" }, { at = [50, 0], from = [80, 0] }]
[set]
K1 = 300
```"""
OLD_SCENE = '```scene\ncontrols = ["K1", "hold"]\n[set]\nK1 = 300\n```'
SLOW = (
    "do = [{ at = 0.2, rate = 0.25 }, { at = 0.5, hold = true }, "
    "{ at = 1.0, start = { across = 5.0 } }, { at = 1.5, hold = false }]"
)
OLD_SCRIPT = "do = [{ at = 0.5, hold = true }, { at = 1.5, hold = false }]"
EXPLAIN = """You drew {{your sketch max or *nothing*}}, and chose: {{your choice}}.

```when wrong
It was *not* that.
```

# explain: Only for some

```step
when = "right"
```

You were right.
"""
FORMAT_LESSON = (
    LESSON.replace(OLD_SCENE, SCENE)
    .replace(OLD_SCRIPT, SLOW)
    .replace("$$\\dot x = v$$\n", EXPLAIN)
    .replace('kind = "bound"', 'kind = "better"\nshare = 0.9')
    .replace("below = 5.0\n", "")
)
assert FORMAT_LESSON.count("when") == 2 and "rate = 0.25" in FORMAT_LESSON
assert '"phase"' in FORMAT_LESSON and '"better"' in FORMAT_LESSON
FORMAT_REFERENCE = """
[hold.solution]
until = 8.0
do = [
  { at = 1.0, hold = true },
  { at = 3.0, reset = true },
  { at = 3.0, hold = false },
  { at = 3.1, set = { K1 = 1600, K2 = 80 } },
  { at = 4.1, hold = true },
]
[hold.failure]
until = 8.0
do = [
  { at = 1.0, hold = true },
  { at = 3.0, reset = true },
  { at = 3.0, hold = false },
  { at = 4.0, hold = true },
]
"""
