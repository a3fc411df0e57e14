"""The concept test, and what a class gains between its two sittings."""
