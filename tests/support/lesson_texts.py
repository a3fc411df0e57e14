"""A small lesson for tests, and ways to make it invalid."""

from __future__ import annotations

from pathlib import Path

LESSON = """+++
title = "A lesson"
summary = "For tests."
minutes = 1
+++

# play: Look around

Which one *waits*? Here is $x^2$, and [set K3 to 100](lab:K3=100).

```scene
controls = ["K1", "hold"]
[set]
K1 = 300
```

# predict: Before

```predict
kind = "sketch"
question = "Draw the distance."
quantity = "distance"
seconds = 2.0
top = 60.0
```

# run: And now

```script
until = 2.0
do = [{ at = 0.5, hold = true }, { at = 1.5, hold = false }]
```

# predict: Once more

```predict
kind = "choice"
question = "Which?"
options = [
  { text = "this", answer = "no" },
  { text = "that", answer = "yes", right = true },
]
```

# run: See

```script
until = 1.0
```

# explain: Why

$$\\dot x = v$$

# task: Do

```scene
path = "ellipse"
```

```task
id = "hold"
text = "Hold back."
hints = ["H", "The key H."]
[[check]]
kind = "bound"
quantity = "distance"
during = "held"
least = 1.0
below = 5.0
```

# quiz: Say

```quiz
question = "And?"
options = [
  { text = "a", answer = "A", right = true },
  { text = "b", answer = "B" },
]
```
"""
REFERENCE = """
[hold.solution]
until = 3.0
do = [{ at = 1.0, hold = true }]
[hold.failure]
until = 1.5
do = [{ at = 1.0, hold = true }]
"""


def write_lesson(
    folder: Path, text: str = LESSON, reference: str = REFERENCE, name: str = "01-a"
) -> Path:
    """Write a course of one lesson; return the lesson's file."""
    home = folder / name
    home.mkdir(parents=True, exist_ok=True)
    (home / "reference.toml").write_text(reference)
    file = home / "en.md"
    file.write_text(text)
    return file
