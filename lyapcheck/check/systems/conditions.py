"""That the conditions of a theorem can be met: one that holds where nothing is says nothing.

They are met where the claim that the last one fails wherever the others hold is false: a point refutes it.
"""

from __future__ import annotations

from collections.abc import Iterator

from lyapcheck.check.expressions.expression import variables
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.statement import Relation
from lyapcheck.check.systems.argument import Argument
from lyapcheck.check.systems.facts import constant, constants_of, product
from lyapcheck.check.systems.system import System


def never_met(argument: Argument) -> Implies | None:
    """That no constants that an arm and its gains can have meet the conditions; none where none is made."""
    if not argument.where:
        return None
    *others, last = argument.where
    used = set().union(*(variables(one.gap) for one in argument.where))
    orders = [one for one in _orders(argument.system) if variables(one.gap) <= used]
    known = constants_of(argument.system)
    fails = Relation(last.right, "<" if last.operator == "<=" else "<=", last.left)
    return Implies(tuple(known[name] for name in sorted(used)), (*others, *orders), fails)


def _orders(system: System) -> Iterator[Relation]:
    """How bounds of one thing lie to each other."""
    yield Relation(constant("mu"), "<=", constant("beta"))
    for name in system.diagonal:
        least, greatest, norm = (constant(f"{name}_{end}") for end in ("min", "max", "norm"))
        yield Relation(least, "<=", greatest)
        yield Relation(least, "<=", norm)
        yield Relation(greatest, "<=", norm)
    for f in system.functions:
        secant, sector = constant(f"{f.name}_secant"), constant(f"{f.name}_sector")
        yield Relation(product(secant, sector), "<=", ("num", "1"))
        if f.member is not None:
            slope, reach, share = (constant(f"{f.name}_{end}") for end in ("slope", "reach", "share"))
            lowest = f.member.low / (1 + abs(f.member.start))  # of f(x)/(1 + x)
            yield Relation(("num", str(lowest)), "<=", share)
            yield Relation(("num", str(f.member.secant)), "<=", secant)
            yield Relation(("num", str(f.member.rho)), "<=", slope)
            yield Relation(product(("num", str(f.member.secant)), sector), "<=", ("num", "1"))
            if f.member.gamma is not None:
                yield Relation(("num", str(f.member.gamma)), "<=", reach)
