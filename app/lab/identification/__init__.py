"""Identification of the model that a lab's controllers use, from how a robot has moved."""
