"""Lessons played without a student, to check them and to compute what happens in a step."""
