"""The published derivation apart from the checker: (12)–(15) for n joints, in polynomials and in SymPy."""
