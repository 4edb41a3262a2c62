"""The kinds of statement, one file a kind: data, form, text, proofs and the rules that judge them.

Importing this enters all rules in ``verify.RULES``. A new kind is a new file here and its name below.
"""

from lyapcheck.check.kinds import (
    agrees,
    all_of,
    bound_every_n,
    compared,
    constant,
    coriolis,
    damping,
    decreasing,
    every_n,
    for_all,
    for_small,
    gravity,
    identity,
    implies,
    inertia,
    loop_property,
    norm_bound,
    theorem,
    trigonometric,
)

__all__ = [
    "agrees",
    "all_of",
    "bound_every_n",
    "compared",
    "constant",
    "coriolis",
    "damping",
    "decreasing",
    "every_n",
    "for_all",
    "for_small",
    "gravity",
    "identity",
    "implies",
    "inertia",
    "loop_property",
    "norm_bound",
    "theorem",
    "trigonometric",
]
