"""Bounded functions beside those of ``members``: a file each, whose ``create(m)`` gives its ``Member``."""
