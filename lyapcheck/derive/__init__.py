"""What SymPy derives from U_m and the closed loop, and from which all code of it is made."""
