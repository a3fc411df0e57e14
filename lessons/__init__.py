"""Lessons: texts and pure checks on what happened in a run."""
