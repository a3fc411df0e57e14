"""The composition root: the web server, and a lab for every browser tab."""
