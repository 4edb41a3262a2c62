"""The architecture and the public names."""
