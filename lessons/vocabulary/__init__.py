"""The names that a lesson may use, and the checks that it uses only those."""
