"""The page of a class's teacher: what it shows, as data, and what the teacher does there."""
