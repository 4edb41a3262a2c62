"""How a proof script writes its statements; what they are made of is in ``check.kinds``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, TypeVar

from lyapcheck.check.expressions.expression import variables
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.constant import Agrees
from lyapcheck.check.kinds.decreasing import DampingBelow, Decreasing
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.statement import Relation, Statement, Variable
from lyapcheck.claims.claim import lacking
from lyapcheck.claims.expressions import Expr, exact_value, expr, var
from lyapcheck.claims.search_result import SearchResult
from lyapcheck.verdicts import Verdict

T = TypeVar("T")


@dataclass(frozen=True)
class Missing:
    """A statement that this case cannot give: a gain set or a robot is lacking."""

    reason: str


def identity(left: object, right: object, variables: Iterable[Variable] = ()) -> Identity:
    """Claim ``left = right`` for all values. Variables that ``variables`` does not name are real."""
    return Identity(expr(left).tree, expr(right).tree, _list(Variable, variables, "variables"))


def for_all(
    relation: Relation,
    low: object | None = None,
    high: object | None = None,
    open_low: bool = False,
    open_high: bool = False,
    variable: str | None = None,
) -> ForAll:
    """Claim a relation for every x from low to high. Ends are included unless open, and None is infinity.

    Raises:
        ValueError: the relation has several variables.
    """
    one = _one(Relation, relation, "relation")
    names = sorted(variables(one.left) | variables(one.right))
    if variable is None and len(names) > 1:
        quoted = ", ".join(f'"{name}"' for name in names)
        raise ValueError(
            f"for_all takes a relation in one variable, this has {quoted}; "
            f"write implies(reals({quoted}), [], relation)"
        )
    return ForAll(one, _end(low), _end(high), open_low, open_high, variable or "".join(names) or "x")


def norm_bound(component: Expr, n: int, bound: object, power: int = 0) -> NormBound:
    """``‖(f(x_i))_i‖ <= bound · ‖x‖^power`` for every x in Rⁿ."""
    return NormBound(component.tree, n, expr(bound).tree, power)


def positive(*names: str) -> tuple[Variable, ...]:
    """Variables that run over all positive reals."""
    return tuple(Variable(name, Fraction(0)) for name in names)


def nonnegative(*names: str) -> tuple[Variable, ...]:
    """Variables that run over all reals >= 0."""
    return tuple(Variable(name, Fraction(0), strict=False) for name in names)


def reals(*names: str) -> tuple[Variable, ...]:
    """Variables that run over all reals."""
    return tuple(Variable(name) for name in names)


class Reals:
    """Real variables, each declared once with its range. A statement uses the variables that occur in it.

    ::

        R = Reals()
        kp, kv = R.positive("kp kv")
        R.implies((kp <= 1, kv <= 1), kp * kv <= 1)
    """

    def __init__(self) -> None:
        self.known: dict[str, Variable] = {}

    def positive(self, names: str) -> list[Expr]:
        """Variables over all positive reals, their names between spaces."""
        return self._declared(positive(*names.split()))

    def nonnegative(self, names: str) -> list[Expr]:
        """Variables over all reals >= 0."""
        return self._declared(nonnegative(*names.split()))

    def real(self, names: str) -> list[Expr]:
        """Variables over all reals."""
        return self._declared(reals(*names.split()))

    def implies(self, hypotheses: Iterable[Relation], conclusion: Relation) -> Implies:
        """For all values of the variables: the hypotheses together give the conclusion."""
        result = implies((), hypotheses, conclusion)
        return replace(result, variables=self.ranges(*result.hypotheses, conclusion))

    def for_small(
        self, small: str, conclusion: Relation, given: Iterable[Relation] = (), unit: str = ""
    ) -> ForSmall:
        """The conclusion for every small enough value of one variable, and all of ``unit`` in (0, 1]."""
        hypotheses, bounded = _list(Relation, given, "given"), tuple(unit.split())
        _one(Relation, conclusion, "conclusion")
        over = (v for v in self.ranges(*hypotheses, conclusion) if v.name not in (small, *bounded))
        return ForSmall(small, tuple(over), hypotheses, conclusion, bounded)

    def ranges(self, *relations: Relation) -> tuple[Variable, ...]:
        """The variables that occur, in the order in which they were declared.

        Raises:
            ValueError: one was not declared.
        """
        used = {name for relation in relations for name in variables(relation.gap)}
        if unknown := used - set(self.known):
            raise ValueError(f"{', '.join(sorted(unknown))}: declare its range first, as in R.positive(...)")
        return tuple(v for name, v in self.known.items() if name in used)

    def _declared(self, variables: tuple[Variable, ...]) -> list[Expr]:
        self.known |= {v.name: v for v in variables}
        return [var(v.name) for v in variables]


def implies(variables: Iterable[Variable], hypotheses: Iterable[Relation], conclusion: Relation) -> Implies:
    """Claim that the hypotheses imply the conclusion, for all values of the variables.

    Raises:
        ValueError: an argument is not a relation or a variable.
    """
    return Implies(
        _list(Variable, variables, "variables"),
        _list(Relation, hypotheses, "hypotheses"),
        _one(Relation, conclusion, "conclusion"),
    )


def all_of(**parts: Statement) -> AllOf:
    """Claim that every part holds. The keywords name the parts, with underscores for spaces."""
    return AllOf(tuple((name.replace("_", " "), _one(Statement, part, name)) for name, part in parts.items()))


def agrees(formula: Expr, printed: str, solve_for: str | None = None, **inputs: str) -> Agrees:
    """A printed number agrees with a formula whose variables are the printed numbers ``inputs``."""
    return Agrees(formula.tree, tuple(sorted(inputs.items())), printed, solve_for)


HOW: dict[type, str] = {
    Relation: "write relations, as in (x <= 1, y < 2), plain numbers as expr(1)",
    Variable: 'write positive("x", "y"), or a sum of such: positive("x") + reals("y")',
    Statement: "write for_all(...), implies(...) or another statement",
}


def _list(kind: type[T], values: object, subject: str) -> tuple[T, ...]:
    """A tuple of what an author listed, each looked at.

    Raises:
        ValueError: it is no list, or something else is in it.
    """
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise ValueError(f"{subject} must be a list, not {type(values).__name__}; {HOW[kind]}")
    return tuple(_one(kind, value, f"{subject}[{index}]") for index, value in enumerate(values))


def _one(kind: type[T], value: object, subject: str) -> T:
    if not isinstance(value, kind):
        wanted = kind.__name__.lower()
        raise ValueError(f"{subject} must be a {wanted}, not {type(value).__name__}; {HOW[kind]}")
    return value


def _end(value: object | None) -> Fraction | None:
    return None if value is None else exact_value(value)


# --- Statements about every state of one arm under one controller, from a robot and a gain set.


def decreasing(robot: Any, gains: Any, eps0: object, ranges: bool = False) -> Decreasing:
    """Claim dV/dt < 0 along (11) at every state except the origin, with V of (13) and this ε₀.

    Args:
        robot: the arm, at its nominal numbers.
        gains: of a bounded family, N·m.
        eps0: an exact positive number.
        ranges: True for all values of the uncertain numbers of the arm.

    Raises:
        Lacking: the gains are for another number of joints, or h is unbounded.
        ValueError: ε₀ is no exact number.
    """
    from lyapcheck.check.kinds.decreasing import statement_of
    from lyapcheck.search.controlled_arm import ControlledArm

    if len(gains.kp) != robot.n:
        raise lacking(f"the gains are for {len(gains.kp)} joints, {robot.name} has {robot.n}")
    controlled = ControlledArm(gains, robot, ranges)
    if not controlled.family.bounded:
        raise lacking("h is unbounded; give gains of a bounded family")
    return statement_of(controlled.loop(exact_value(eps0)))


def damping_below(robot: Any, gains: Any, bound: object) -> DampingBelow:
    """Claim that a bound of λmax(K_v) is necessary for dV/dt < 0 with K_p, κK_v and some ε₀ > 0.

    Args:
        robot: the arm, at its nominal numbers.
        gains: K_p, and K_v up to the factor κ, in N·m.
        bound: a number, N·m.

    Raises:
        Lacking: the gains are for another number of joints, or h is unbounded.
    """
    return DampingBelow.about(decreasing(robot, gains, 1).closed_loop, bound=expr(bound).tree)


def sampled(
    kp: Iterable[object],
    kv: Iterable[object],
    period: object,
    *,
    m: int | None,
    family: str = "hyperbolic",
    robot: Any = None,
    viscous_min: Iterable[object] = (),
    k_g: Iterable[object] = (),
    conclusion: str = "goal",
    longest: object | None = None,
    filter: Iterable[object] = (1,),  # noqa: A002
    **loop: Any,
) -> SampledStable:
    """Claim that gains on a computer make the goal globally asymptotically stable, at every period up to one.

    Args:
        kp, kv: diagonals of K_p and K_v, N·m.
        period: s.
        m, family: of h.
        robot: the arm with all its ranges. Without it, every serial revolute arm with |g_i| ≤ k_gi.
        viscous_min: least friction of each joint, N·m·s/rad. Default: the friction of the robot.
        k_g: bounds of the torques of gravity, N·m.
        conclusion: ``goal``, or ``rest`` if every motion must only stop, under any gravity.
        longest: longest interval between readings, s. Default: the period.
        filter: weights of the differences of readings, the newest first.
        loop: ``delay`` in whole samples, ``velocity`` and ``angles``, as in `LoopRecord`.

    Raises:
        ValueError: the rule (S) does not cover the loop.
    """
    from lyapcheck import asked
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.sampling import LoopRecord, require_sampled

    stiffness, damping, friction, bounds, taps = (
        tuple(map(exact_value, values)) for values in (kp, kv, viscous_min, k_g, filter)
    )
    least = friction or tuple(b.bounds[0] for b in getattr(robot, "viscous", ()))
    angles = loop.pop("angles", "unwrapped")
    runs = LoopRecord(exact_value(period), _end(longest), filter=taps, **{"delay": 0, **loop})
    gains = GainSet("", m, stiffness, damping, family)
    return asked.sampled(gains, require_sampled(runs, angles), least, robot, bounds, conclusion)


# --- Whether the hypotheses of a proved statement hold anywhere: one that holds of nothing says nothing.


NOTHING = "its hypotheses contradict each other: it holds of nothing"
UNMET = "no value was found that meets all hypotheses: it may hold of nothing"


def remarks(statement: Statement, judge: Callable[[Implies], SearchResult]) -> Iterator[str]:
    """What a reader of a proved statement must know of its hypotheses; nothing where a point meets them.

    Args:
        statement: parts of it are named.
        judge: a search whose proofs the checker has verified: of the claim that the hypotheses give
            1 <= 0, which a point that meets them refutes, and of claims that they contradict each other.
    """
    if isinstance(statement, AllOf):
        for name, part in statement.parts:
            yield from (f"{name}: {remark}" for remark in remarks(part, judge))
    elif isinstance(statement, (Implies, ForSmall)) and statement.hypotheses:
        together = _together(statement)
        if judge(together).verdict is not Verdict.REFUTED:
            decided = any(judge(one).verdict is Verdict.PROVED for one in _contradictions(together))
            yield NOTHING if decided else UNMET


def _together(statement: Implies | ForSmall) -> Implies:
    """That the hypotheses of a statement give 1 <= 0."""
    variables, given = statement.variables, statement.hypotheses
    if isinstance(statement, ForSmall):
        variables += positive(statement.small, *statement.bounded)
        given += tuple(var(name) <= 1 for name in statement.bounded)
    return Implies(variables, given, expr(1) <= 0)


def _contradictions(together: Implies) -> Iterator[Implies]:
    """Statements of which each says that no point meets all hypotheses: the others give that one fails."""
    yield together
    given = together.hypotheses
    for k, one in enumerate(given):
        fails = Relation(one.right, "<=" if one.strict else "<", one.left)
        yield Implies(together.variables, (*given[:k], *given[k + 1 :]), fails)
