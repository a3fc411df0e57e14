"""The 3D scene, and what the mouse does in it."""
