"""Curves, how a user makes one, and the closest point on it."""
