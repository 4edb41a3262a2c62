"""Untrusted and fast: whatever is found here is a candidate until ``check`` has confirmed it."""
