"""The trusted checker: what it accepts, and above all what it refuses."""
