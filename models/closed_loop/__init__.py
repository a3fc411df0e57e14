"""One control tick as one function, interpreted or compiled, and its record."""
