"""Robots with fewer motors than coordinates, each a module as the catalogue finds them."""
