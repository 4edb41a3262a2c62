"""Benchmarks: lyapcheck beside what a user would do by hand, in one run; python -m tests.benchmarks."""
