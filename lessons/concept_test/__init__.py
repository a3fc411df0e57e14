"""The concept test, and the gain of a class between its two sittings."""
