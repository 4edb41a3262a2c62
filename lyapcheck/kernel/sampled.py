"""``SampledStable`` before Coq's kernel, in the words of ``formal/SampledDefinitions.v``."""

from __future__ import annotations

from fractions import Fraction
from math import ceil

from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.kinds.sampled import SampledStable, ShortPeriod
from lyapcheck.check.numbers.members import member
from lyapcheck.check.statement import Proof
from lyapcheck.kernel.terms import NotPrinted, exact, exact_list, monomials, ranges_of

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
