"""Proof-check reports: one Report object, and renderers that are pure functions of it."""
