"""The paper's proof, claim by claim, in the order of the text.

Every claim says what the paper says and states it as data; what comes of it is computed.
Ids follow the numbers of the paper's equations.
"""

from lyapcheck.claims import (
    Constant,
    Proof,
    agrees,
    all_of,
    cosh,
    dh,
    diff,
    expr,
    for_all,
    gamma,
    h,
    identity,
    norm_bound,
    pi,
    rho,
    sinh,
    sqrt,
    total,
    var,
)

proof = Proof(
    "published",
    "A family of hyperbolic-type control schemes for robot manipulators, as published",
    reference="reyes2019family",
)

x = var("x")
JOINTS = ("base", "shoulder", "elbow")

# Section 3: the family ------------------------------------------------------------------------------------

FAMILY = "Section 3: the family"
PRINTED_GAMMA = {1: "1", 2: "1.05", 3: "1.11"}


@proof.claim("6", "h_m is odd, continuous, bounded, and zero only at 0", place="(6), Fig. 1", section=FAMILY)
def _(case):
    m = case.m
    return all_of(
        odd=identity(h(m, -x), -h(m, x)),
        denominator_never_zero=for_all(expr(0) < 1 + sinh(x) ** (2 * m)),
        bounded_above=for_all(h(m, x) <= "3/2"),
        bounded_below=for_all(expr("-3/2") <= h(m, x)),
        positive_for_positive_x=for_all(expr(0) < h(m, x), 0, open_low=True),
    )


@proof.claim("7a", "‖h_m(x)‖ ≤ √n γ_m for all x in Rⁿ", place="(7), first line", section=FAMILY, uses=["6"])
def _(case):
    return norm_bound(h(case.m, x), case.n, sqrt(case.n) * gamma(case.m))


@proof.claim(
    "7b", "‖h_m(x)‖ ≤ √n γ_m ‖x‖ for all x in Rⁿ", place="(7), second line", section=FAMILY, uses=["6"]
)
def _(case):
    return norm_bound(h(case.m, x), case.n, sqrt(case.n) * gamma(case.m), power=1)
