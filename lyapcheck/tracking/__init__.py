"""The tracking scheme (21): reference trajectories, simulation, and what theory promises of it."""
