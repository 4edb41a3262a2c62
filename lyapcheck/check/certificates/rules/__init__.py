"""The rules of the checker, one file a kind of statement; importing this enters them all."""

from lyapcheck.check.certificates.rules import (
    all_of,
    chain,
    damping,
    decreasing,
    every_n,
    identity,
    implication,
    interval,
    norm_bounds,
    norms,
    numbers,
    printed,
    small,
    theorem,
    trigonometric,
)

__all__ = [
    "all_of",
    "chain",
    "damping",
    "decreasing",
    "every_n",
    "identity",
    "implication",
    "interval",
    "norm_bounds",
    "norms",
    "numbers",
    "printed",
    "small",
    "theorem",
    "trigonometric",
]
