"""Mechanical systems, robots, their parameters, and forces on them."""
