"""Measures a running lab: time per tick, clients, delay of the mouse."""
