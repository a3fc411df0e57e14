"""What of a lesson depends on the student's answers."""
