"""Storage: the database, its tables, and who may write to them."""
