"""Measures a running lab: time per tick, many clients, latency of the mouse."""
