"""Reading what users write: exact decimals, the place of every key, every problem at once."""
