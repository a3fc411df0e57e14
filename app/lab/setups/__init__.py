"""Set-ups of a lab as data: captured, checked, restored, stored, and shared as codes."""
