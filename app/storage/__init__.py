"""What is kept: databases and their tables."""
