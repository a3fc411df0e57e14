"""Robots from URDF, xacro and MJCF files, read to chains of bodies."""
