"""Renderers and escapes."""
