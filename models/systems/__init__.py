"""Equations of motion, robots, their parameters, and external forces."""
