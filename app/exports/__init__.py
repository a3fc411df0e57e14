"""What a user takes home: data, pictures, videos, reports."""
