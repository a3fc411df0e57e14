"""The simulation thread."""
