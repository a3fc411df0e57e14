"""Pages without a server: a figure with one or two sides in one file."""
