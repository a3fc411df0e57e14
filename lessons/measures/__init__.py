"""Measures of a run beyond the values of its quantities."""
