"""The 3D scene and its mouse interaction."""
