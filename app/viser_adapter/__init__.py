"""Everything that touches viser's private parts, and the checks on what a browser sends."""
