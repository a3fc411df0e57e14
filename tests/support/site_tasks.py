"""What tests know of the course's tasks on a site."""

ONLY_IN_LAB = ("excite", "excite-well")
ROUGH = ("clover", "real-one")
"""Here the last bits of a bent path, or of a speed limit, decide on an encoder's step."""
