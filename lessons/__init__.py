"""Lessons: their file format, and pure functions that check what happened in a run."""
