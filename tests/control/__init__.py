"""Gains, limits and conditions."""
