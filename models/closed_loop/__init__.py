"""One control tick as one function, interpreted or compiled, and the record of a run."""
