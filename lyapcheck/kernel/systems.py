"""Which systems are loops that ``formal/Definitions.v`` knows: (11) under (6) with h_m, and V of (13).

Letters may have any names; torques and energies are compared as the checker compares numbers for every n.
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.letters.words import Words
from lyapcheck.check.systems.argument import Argument
from lyapcheck.check.systems.system import DG, GD, M, S, System, W, minus
from lyapcheck.kernel.terms import NotPrinted

X: Tree = ("var", "x")
EPS0: Tree = ("var", "eps0")
TEST: Tree = ("vec", "x")
GLOBAL = ("strict", "LaSalle")
"""Theorems that conclude global asymptotic stability of a goal, which is what Coq is asked."""


def member_of(argument: Argument) -> int:
    """The m for which a theorem says that (6) with h_m makes the goal of every arm with friction stable.

    Raises:
        NotPrinted: it is about another loop, or says something else.
    """
    system = argument.system
    if argument.theorem not in GLOBAL or argument.local:
        raise NotPrinted(f"the conclusion of the theorem {argument.theorem}")
    if len(system.gains) != 2 or system.states or system.desired or system.disturbed:
        raise NotPrinted("a loop that is not (11)")
    if system.friction != "positive":
        raise NotPrinted("arms without friction")
    if [f.of for f in system.functions] != ["e", "w"]:
        raise NotPrinted("a loop without a function of q̃ and one of q̇")
    if not _same(("dot", TEST, system.torque), ("dot", TEST, _torque(system))):
        raise NotPrinted("a torque that is not (6)")
    first, second = (_member(f.member.value if f.member else ()) for f in system.functions)
    if first != second:
        raise NotPrinted("two functions that differ")
    return first


def member_of_energy(argument: Argument) -> int:
    """The same m, if V is that of (13).

    Raises:
        NotPrinted: it is another one.
    """
    m = member_of(argument)
    if argument.gravity or not _same(argument.energy, _energy(argument.system)):
        raise NotPrinted("V that is not (13)")
    return m


def on_one_arm(statement: StableArm) -> Decreasing:
    """That dV/dt < 0 for V of (13), the arm, the gains and ε₀.

    Raises:
        NotPrinted: V is another one, or ε₀ has no number.
    """
    numbers, m = dict(statement.numbers), member_of_energy(statement.argument)
    if "eps0" not in numbers:
        raise NotPrinted("V of (13) without a number for ε₀")
    (_, kp), (_, kv) = statement.gains
    ends: tuple[tuple[Fraction, Fraction], ...] = tuple((b, b) for b in statement.arm.viscous)
    return Decreasing(statement.arm.mass, ends, (), "hyperbolic", m, kp, kv, numbers["eps0"], ())


def _member(value: Tree) -> int:
    """The m of h_m."""
    if len(value) == 3 and value[0] == "h" and value[2] == X:
        return int(value[1])
    raise NotPrinted("a function that is not of the family h_m")


def _torque(system: System) -> Tree:
    """(6): K_p h − K_v k + g(q)."""
    kp, kv = (("diag", name) for name in system.gains)
    h, k = (("vec", f.name) for f in system.functions)
    return ("sum", ("apply", kp, h), minus(("apply", kv, k)), GD, DG)


def _energy(system: System) -> Tree:
    """(13): ½ yᵀMy + Σ k_pi U(e_i), y = w − ε₀ s h."""
    name = system.functions[0].name
    y: Tree = ("sum", W, ("scale", ("neg", ("mul", EPS0, S)), ("vec", name)))
    kinetic: Tree = ("div", ("dot", y, ("apply", M, y)), ("num", "2"))
    return ("add", kinetic, ("dot", ("vec", system.gains[0]), ("vec", f"U{name}")))


def _same(left: Tree, right: Tree) -> bool:
    """Whether two numbers are equal for every n."""
    return is_zero(Words(("M",), {}, {}).number(("add", left, ("neg", right))))
