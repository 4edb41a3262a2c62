"""The bounded functions h."""
