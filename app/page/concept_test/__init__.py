"""The concept test on a student's page."""
