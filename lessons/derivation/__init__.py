"""Derivations by hand: chains of lines, each a typed number or formula that is checked."""
