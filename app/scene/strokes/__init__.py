"""What is drawn by hand in the scene: paths, and predictions as sketches."""
