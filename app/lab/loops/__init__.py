"""Closed loops of labs: made in the background, kept, and waited for by changes of laws."""
