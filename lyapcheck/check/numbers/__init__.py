"""Exact and enclosed numbers: polynomials, harmonics, matrices, the family h and its constants."""
