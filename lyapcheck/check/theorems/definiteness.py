"""Whether a statement shows that an entry or minor of Θ is positive for every ε in (0, ε₀].

The statement may be one for small ε₀, with ε = ε₀·share; one under a condition on ε₀ = ε + rest; or one in
numbers, with ε = x ε₀ and x in (0, 1], which may have been divided by ε.
"""

from __future__ import annotations

from lyapcheck.check.expressions.expression import Tree, Unsupported, substitute
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.statement import Relation, Statement, Variable
from lyapcheck.check.theorems.closed_loop import ClosedLoop

EPS, EPS0, X = (("var", name) for name in ("eps", "eps0", "x"))
POSITIVE = frozenset({"eps", "eps0", "kp", "b_min", "beta"})
"""What is positive in every loop; the other constants may vanish, but are not negative."""
B_MAX: Tree = ("add", ("var", "b_min"), ("var", "more"))
MOST_FACTORS = 2


def shows_positive(statement: Statement, target: Tree, loop: ClosedLoop) -> bool:
    """Whether a statement, if it is true, says that ``target`` > 0 for every ε in (0, ε₀].

    Args:
        statement: any statement.
        target: an expression in the constants of ``loop.form``.
        loop: what is asked of ε₀, and the numbers if it has them.
    """
    if loop.numbers:
        return _in_numbers(statement, target, loop)
    if isinstance(statement, ForSmall) and not loop.condition:
        small = statement.small == "eps0" and statement.bounded == ("share",) and not statement.hypotheses
        within = substitute(target, {"eps": ("mul", EPS0, ("var", "share")), "b_max": B_MAX})
        return small and _all_values(statement.variables) and _says(statement.conclusion, within)
    if isinstance(statement, Implies) and loop.condition:
        given = tuple(_with_rest(relation) for relation in loop.condition)
        return (
            statement.hypotheses == given
            and _all_values(statement.variables)
            and _says(statement.conclusion, target)
        )
    return False


def _in_numbers(statement: Statement, target: Tree, loop: ClosedLoop) -> bool:
    """The same for x from 0 to 1, perhaps divided by x ε₀ once or twice."""
    values = {name: ("num", str(value)) for name, value in loop.numbers}
    eps: Tree = ("mul", X, values.get("eps0", EPS0))
    if isinstance(statement, ForAll):
        whole = statement.low == 0 and statement.high == 1 and statement.variable == "x"
        if not whole or statement.open_low or statement.open_high:
            return False
    elif not isinstance(statement, Constant):
        return False
    relation = statement.relation
    within = substitute(target, values | {"eps": eps})
    factors = (("mul", relation.gap, *[eps] * k) for k in range(MOST_FACTORS + 1))
    return relation.strict and any(_equal(within, one) for one in factors)


def _all_values(variables: tuple[Variable, ...]) -> bool:
    """Whether the variables run over all values that the constants may have."""
    return all(v.low is None or (v.low == 0 and (not v.strict or v.name in POSITIVE)) for v in variables)


def _with_rest(relation: Relation) -> Relation:
    """A relation in ε₀ as one in ε and what is left of ε₀."""
    whole = {"eps0": ("add", EPS, ("var", "rest"))}
    return Relation(substitute(relation.left, whole), relation.operator, substitute(relation.right, whole))


def _says(relation: Relation, target: Tree) -> bool:
    return relation.strict and _equal(relation.gap, target)


def _equal(left: Tree, right: Tree) -> bool:
    try:
        return is_zero(("add", left, ("neg", right)))
    except Unsupported:
        return False
