"""What every verdict of the checker takes for granted; what a theorem takes for granted stands with it."""

GENERAL = (
    "a statement means what its symbols mean for real numbers; whether a robot is so, no certificate says",
    "Python, its integers and fractions, and SHA-256, by which certificates name each other",
    "python-flint and FLINT: exact polynomials and matrices, and balls that contain what they enclose",
    "doubles of IEEE 754: each corner of a box is the rational number that its double is",
    "that the code of the checker itself is right: recheck --trusted lists it for each verdict",
)
