"""A class: its members, their predictions, and the teacher's orders."""
