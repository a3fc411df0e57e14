"""What a page and the server say to each other: the messages, and how they are read and made."""
