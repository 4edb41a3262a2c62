"""Closed loops that Coq's definitions know: sampled ones, and those under (6) or (21) with V of (13)."""

from __future__ import annotations

from fractions import Fraction
from math import ceil

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.kinds.sampled import SampledStable, ShortPeriod
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.letters.words import Words
from lyapcheck.check.numbers.members import member
from lyapcheck.check.statement import Proof
from lyapcheck.check.systems.argument import Argument
from lyapcheck.check.systems.system import DDQD, DG, DQD, GD, B, C, D, G, M, S, System, W, minus
from lyapcheck.kernel.terms import NotPrinted, exact, exact_list, monomials, ranges_of

# --- ``SampledStable`` in the words of ``formal/SampledDefinitions.v``.


DIGITS = 10**4
LARGEST_M = 12
"""``formal/Sharp.v`` has γ_m, ρ_m and L_m up to it."""


def sampled_proposition(statement: SampledStable) -> str:
    """Of any robot with the same friction, which says more where M is given.

    Raises:
        NotPrinted: there is no such theorem.
    """
    says = f"sampled_{statement.conclusion}"
    if statement.links:
        raise NotPrinted("the gravity of a chain of links")
    if statement.k_g:
        return f"of_bounds {_computed(statement)} {exact_list(statement.k_g)} {says}"
    pulled = f"{monomials(statement.potential)} {ranges_of(statement.parameters)}"
    return f"of_potential {_computed(statement)} {pulled} {says}"


def sampled_script(statement: SampledStable, proof: Proof) -> str:
    """The tactics: constants of the library, then booleans that Coq computes.

    Raises:
        NotPrinted: a bound of gravity is shown in another way than by the sizes of harmonics, or (S) holds
            with finer constants than those of the library alone.
    """
    sizes = isinstance(proof, ShortPeriod) and all(isinstance(own, HarmonicSizes) for own in proof.gravity)
    if not isinstance(proof, ShortPeriod) or not sizes:
        raise NotPrinted("a bound of gravity by boxes or levers")
    if _is_near(statement, statement.k_g or proof.k_g):
        raise NotPrinted("a border nearer than ρ_m and L_m to four digits tell")
    m, by = _m(statement), "bounds" if statement.k_g else "potential"
    bounds = " ".join(f"Sharp.{name}_{m}_bound" for name in ("h", "dh", "secant"))
    return (
        f"match goal with |- of_{by} ?D {'_' if statement.k_g else '_ _'} _ => "
        f"apply (Period.{by}_{statement.conclusion} D _ _ _ "
        f"{exact_list(statement.k_g or proof.k_g)} ltac:(cbn; lia) {bounds}) end; "
        "vm_cast_no_check (eq_refl true)."
    )


def _is_near(statement: SampledStable, k_g: tuple[Fraction, ...]) -> bool:
    """Whether (S) fails with the constants of ``formal/Sharp.v``, which are rounded up to four digits."""
    known = member(statement.family, statement.m)
    secant, slope = (Fraction(ceil(x * DIGITS), DIGITS) - x for x in (known.L, known.rho))
    spread = sum(map(abs, statement.taps))
    late = (Fraction(1, 2) + statement.delay) * statement.period
    gains = zip(statement.kp, statement.kv, strict=True)
    more = [statement.stretch * (secant * v * spread + late * slope * p) for p, v in gains]
    rows = zip(statement.viscous_min, statement.needed(k_g), more, strict=True)
    return any(have <= want + rest for have, want, rest in rows)


def _computed(statement: SampledStable) -> str:
    numbers = (statement.kp, statement.kv, statement.viscous_min, statement.taps)
    return (
        f"(Computed {statement.n} {_m(statement)} {' '.join(map(exact_list, numbers))} "
        f"{statement.delay} {exact(statement.period)} {exact(statement.stretch)})"
    )


def _m(statement: SampledStable) -> int:
    m = 1 if statement.family == "tanh" else statement.m
    if statement.family not in ("hyperbolic", "tanh") or m is None or m > LARGEST_M:
        raise NotPrinted(f"the function {statement.family} with m = {m}")
    return m


# --- Which systems are loops that ``formal/Definitions.v`` knows: under (6) or (21) with h_m, and V of (13).
#
# Letters may have any names; torques and energies are compared as the checker compares numbers for every n.


X: Tree = ("var", "x")
EPS0: Tree = ("var", "eps0")
TEST: Tree = ("vec", "x")
GLOBAL = {False: ("strict", "LaSalle"), True: ("uniform",)}
"""Theorems that conclude global asymptotic stability: of a goal at rest, and uniform of one that moves."""


def member_of(argument: Argument) -> int:
    """The m for which a theorem says that (6) with h_m makes the goal of every arm with friction stable.

    With (21) instead of (6) if the goal moves.

    Raises:
        NotPrinted: it is about another loop, or says something else.
    """
    system = argument.system
    if argument.theorem not in GLOBAL[system.desired] or argument.local:
        raise NotPrinted(f"the conclusion of the theorem {argument.theorem}")
    if len(system.gains) != 2 or system.states or system.disturbed:
        raise NotPrinted("a loop that is not (11)")
    if system.friction != "positive":
        raise NotPrinted("arms without friction")
    if [f.of for f in system.functions] != ["e", "w"]:
        raise NotPrinted("a loop without a function of q̃ and one of q̇")
    if not _same(("dot", TEST, system.torque), ("dot", TEST, _torque(system))):
        raise NotPrinted("a torque that is neither (6) nor (21)")
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
    """(6): K_p h − K_v k + g(q); (21): with M q̈_d + C(q, q̇) q̇_d + B q̇_d besides."""
    kp, kv = (("diag", name) for name in system.gains)
    h, k = (("vec", f.name) for f in system.functions)
    more: tuple[Tree, ...] = (GD, DG)
    if system.desired:
        more = (("apply", M, DDQD), ("apply", ("sum", C, D), DQD), ("apply", B, DQD), G)
    return ("sum", ("apply", kp, h), minus(("apply", kv, k)), *more)


def _energy(system: System) -> Tree:
    """(13): ½ yᵀMy + Σ k_pi U(e_i), y = w − ε₀ s h."""
    name = system.functions[0].name
    y: Tree = ("sum", W, ("scale", ("neg", ("mul", EPS0, S)), ("vec", name)))
    kinetic: Tree = ("div", ("dot", y, ("apply", M, y)), ("num", "2"))
    return ("add", kinetic, ("dot", ("vec", system.gains[0]), ("vec", f"U{name}")))


def _same(left: Tree, right: Tree) -> bool:
    """Whether two numbers are equal for every n."""
    return is_zero(Words(("M",), {}, {}).number(("add", left, ("neg", right))))
