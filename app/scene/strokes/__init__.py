"""Freehand drawing in the scene: paths, and predictions as sketches."""
