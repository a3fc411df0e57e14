"""Sentences that say what the lab does: their marks, and how they are found."""
