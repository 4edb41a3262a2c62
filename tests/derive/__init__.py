"""What SymPy derives, and what is made of it."""
