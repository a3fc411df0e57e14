"""Pages that need no server: a figure with one or two sides in one file."""
