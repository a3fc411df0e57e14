"""What is shown of a lab, as data: its parts, their geometry, and their bytes."""
