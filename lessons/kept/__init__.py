"""Students' choices, kept so that they can be identified after a lesson has changed."""
