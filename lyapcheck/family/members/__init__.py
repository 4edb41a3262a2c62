"""One family a file; each offers ``create(m)``."""
