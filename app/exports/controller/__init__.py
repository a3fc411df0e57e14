"""A controller as C, for a robot that is elsewhere."""
