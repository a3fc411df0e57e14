"""Paths from files that other programs wrote: points, SVG drawings, G-code."""
