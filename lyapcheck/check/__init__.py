"""The trusted checker: exact polynomials, balls, certificates; standard library and python-flint only."""
