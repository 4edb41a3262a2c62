"""The command line, and the tools that run it."""
