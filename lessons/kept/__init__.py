"""What a student chose, kept so that it can be told apart after a lesson has changed."""
