"""A step of a lesson as HTML, the same wherever the lesson is played."""
