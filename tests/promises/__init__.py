"""Commands asked about ranges, and then about a member of these ranges: no promise may fail there."""
