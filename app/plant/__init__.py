"""A controller in a process of its own, for a plant elsewhere that is reached by UDP."""
