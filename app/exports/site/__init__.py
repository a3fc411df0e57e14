"""The course as a static site: lessons with live figures, without a server."""
