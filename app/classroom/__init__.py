"""A class: who is in it, what they predicted, what the teacher wants."""
