"""A step of a lesson as a page shows it: HTML and data, for whatever plays the lesson."""
