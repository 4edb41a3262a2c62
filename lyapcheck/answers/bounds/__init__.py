"""Certified bounds of a motion beside what a simulation of it shows."""
