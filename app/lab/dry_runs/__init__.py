"""Lessons that are played without a student: to check them, and to know what happens in a step."""
