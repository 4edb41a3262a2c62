"""Closed loops for every n as data, and what theorems ask of them.

- ``system``: the arm (1) under a torque that is an expression; how letters move, and what is left at rest;
- ``facts``: how large the letters are, from the properties of the arm, gains and functions;
- ``forms``: quadratic forms in such sizes, when they are positive, and which states they see;
- ``theorems``: each theorem as a table of obligations;
- ``conditions``: that the conditions of an argument can be met.

References: ``khalil2002nonlinear``, chapter 4; ``kelly2005control``, chapters 2 and 4.
"""
