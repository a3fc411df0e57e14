"""Export of data, pictures, recordings and reports."""
