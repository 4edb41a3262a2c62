"""Tests, a folder a room of the house."""
