"""Paths from files that other programs wrote: points, signatures, SVG drawings, G-code."""
