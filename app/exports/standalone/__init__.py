"""Pages that need no server: a figure with one or two benches in one file."""
