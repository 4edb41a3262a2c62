"""What every verdict of the checker takes for granted; what a theorem takes for granted stands with it."""

GENERAL = (
    "a statement means what its symbols mean for real numbers; whether a robot is so, no certificate says",
    "Python, its integers and fractions, and SHA-256, by which certificates name each other",
    "python-flint and FLINT: exact polynomials and matrices, and balls that contain what they enclose",
    "doubles of IEEE 754: each corner of a box is the rational number that its double is",
    "that the code of the checker itself is right: recheck --trusted lists it for each verdict",
)

TORQUE = (
    "the torque is (6), τ = K_p h(e) − K_v h(w) + g(q) with e = q_d − q, w = q̇ and a constant q_d, applied "
    "as it is, and (6) knows g(q) exactly; (11) is M(q)q̈ + C(q,q̇)q̇ + Bq̇ + g(q) = τ with it"
)
"""What statements about the closed loop (11) with numbers take for granted of the torque."""
