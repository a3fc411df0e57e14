"""Small helpers that every folder of the lab may use."""
