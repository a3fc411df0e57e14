"""Functions, to be translated, for pages without a server: everything but closed loops."""
