"""The bounded functions that the checker knows: a file each, whose ``create(m)`` gives its ``Member``."""
