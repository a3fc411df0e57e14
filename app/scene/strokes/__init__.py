"""Freehand drawing of paths in the scene."""
