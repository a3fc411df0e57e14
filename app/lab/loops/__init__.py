"""The labs' closed loops: compiled in the background, cached, and awaited by the labs."""
