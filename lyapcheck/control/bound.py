"""γ, the bound of a bounded function, as a term that the checker knows."""

from __future__ import annotations

from lyapcheck.errors import argument_error

TYPE_CHECKING = False
if TYPE_CHECKING:
    from lyapcheck.check.expressions.expression import Tree
    from lyapcheck.control.gains import GainSet

PRINTED = {1: "1", 2: "21/20", 3: "111/100"}
"""γ_1, γ_2, γ_3 as the paper prints them (Table 2): the last two are below the true ones."""
_GAMMAS: dict[str, Tree | None] = {
    "tanh": ("num", "1"),
    "algebraic": ("num", "1"),
    "arctan": ("div", ("pi",), ("num", "2")),
    "linear": None,
}


def gamma_of(gain_set: GainSet, source: str = "true") -> Tree | None:
    """γ of a gain set, the true one or the one the paper prints; ``None`` where h is unbounded.

    Raises:
        InputError: the paper prints no γ for this m.
    """
    if source == "printed":
        if gain_set.family != "hyperbolic" or gain_set.m not in PRINTED:
            raise argument_error(
                "--gamma", source, f"the paper prints no γ for {gain_set.name}", "use the true γ"
            )
        return "num", PRINTED[gain_set.m]
    return ("gamma", gain_set.m) if gain_set.family == "hyperbolic" else _GAMMAS[gain_set.family]
