"""Expressions of real variables as data: their grammar, values, normal forms and signs."""
