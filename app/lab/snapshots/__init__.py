"""Snapshots of a lab as data: their parts, their geometry, and their encoding."""
