"""The parts of a lesson that depend on the student's answers."""
