"""A proof with mistakes in it, as an example of what becomes of them; run it like ``arctan.py``.

- ``wrong`` has an inequality the wrong way round. It comes out refuted: the witness is a rational x, and both
  sides at x lie in intervals that do not touch.
- ``rests`` is a correct step that uses ``wrong``. It is undecided, and says on what it rests.
- ``sign`` is V of the paper's (12) with the wrong sign of one term. As an identity in many variables it is
  refuted by values of all of them.
- ``large`` asks for dV/dt < 0 with an ε₀ that is too large. It is refuted by one state of the arm.
- ``right`` shows that claims which do not use a wrong one are not touched.

The command ends with exit code 1, which says that something was refuted.
"""

from lyapcheck.claims import (
    Constant,
    Proof,
    atan,
    decreasing,
    expr,
    for_all,
    form,
    identity,
    matrix,
    positive,
    var,
    vector,
)

proof = Proof("must_fail", "A proof that must not be accepted")

x = var("x")


@proof.claim("wrong", "arctan x ≤ x − x³/3 for x ≥ 0 (it is ≥)")
def _():
    return for_all(atan(x) <= x - x**3 / 3, 0)


@proof.claim("rests", "so arctan 1 ≤ 2/3 < 0.7", uses=["wrong"])
def _():
    return Constant(expr(2) / 3 < "0.7")


@proof.claim("sign", "½yᵀMy = ½q̇ᵀMq̇ + ε hᵀMq̇ + ½ε² hᵀMh (the second sign must be −)")
def _(n):
    w, h, M = vector("w", n), vector("h", n), matrix("M", n, symmetric=True)
    ε = var("eps0") / (1 + var("r"))
    y = [w_i + -ε * h_i for w_i, h_i in zip(w, h, strict=True)]
    expanded = form(w, M, w) / 2 + ε * form(h, M, w) + ε**2 * form(h, M, h) / 2
    return identity(form(y, M, y) / 2, expanded, positive("r"))


@proof.claim("large", "dV/dt < 0 at every state but the origin with ε₀ = 2")
def _(robot, gains):
    return decreasing(robot, gains, 2)


@proof.claim("right", "x − x³/3 ≤ arctan x for x ≥ 0")
def _():
    return for_all(x - x**3 / 3 <= atan(x), 0)
