"""What a certificate may bring forward for or against a statement, as data; one class a rule of the checker.

Nothing here is believed: each rule in ``rules`` recomputes what follows from the statement alone, and takes
from these data only what would be long to find (points, boxes, multipliers, choices).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

Point = tuple[tuple[str, Fraction], ...]
Monomial = tuple[tuple[int, int], ...]
"""Pairs (generator, exponent)."""


class Proof:
    """A proof or a refutation by one rule."""

    rule: ClassVar[str]


@dataclass(frozen=True)
class Witness(Proof):
    """A rational point at which the statement fails, as balls of ``bits`` show."""

    rule = "witness"
    point: Point
    bits: int = 192


@dataclass(frozen=True)
class NormalForm(Proof):
    """Both sides have the same normal form over ℚ."""

    rule = "normal form"


@dataclass(frozen=True)
class ExactNumbers(Proof):
    """The difference of both sides is rational, or its normal form is zero."""

    rule = "exact numbers"


@dataclass(frozen=True)
class SeparateBalls(Proof):
    """Both sides lie in balls of ``bits`` that tell them apart."""

    rule = "separate balls"
    bits: int


class Piece:
    """How the sign of a function of one variable is shown on one part of its domain."""

    rule: ClassVar[str]


@dataclass(frozen=True)
class Sturm(Piece):
    """By Sturm's theorem: the function is a quotient of polynomials in x alone or in exp(x) alone."""

    rule = "Sturm"


@dataclass(frozen=True)
class Boxes(Piece):
    """By Taylor's formula on the boxes between neighbouring ``cuts``.

    With ``from_zero``, the first Taylor coefficient that is not zero gives the sign from 0 to the first cut;
    with ``to_infinity``, the dominant term gives it beyond the last cut.
    """

    rule = "Taylor boxes"
    cuts: tuple[Fraction, ...]
    from_zero: bool
    to_infinity: bool
    bits: int


@dataclass(frozen=True)
class Pieces(Proof):
    """One proof for each piece of the domain: the part right of 0, then the part left of it, reflected."""

    rule = "pieces of the domain"
    pieces: tuple[Piece, ...]


@dataclass(frozen=True)
class Supremum(Proof):
    """The bound is no smaller than √n times the supremum that γ_m or ρ_m is by definition."""

    rule = "supremum"
    numbers: Proof


@dataclass(frozen=True)
class EqualEntries(Proof):
    """All entries equal is the worst case: f(t) <= c/√n and −f(t) <= c/√n for every t."""

    rule = "equal entries"
    above: Proof
    below: Proof


@dataclass(frozen=True)
class OneEntry(Proof):
    """One entry alone is the worst case: |f(t)| <= c|t|, as four inequalities (see the rule)."""

    rule = "one entry"
    parts: tuple[Proof, ...]


@dataclass(frozen=True)
class Multiple:
    """``weight · monomial · gap of a hypothesis``."""

    hypothesis: int
    weight: Fraction
    monomial: Monomial


@dataclass(frozen=True)
class SignIdentity(Proof):
    """``lift · gap of the conclusion = Σ multiples + R``, in which no term of R is negative."""

    rule = "identity of signs"
    lift: Monomial
    multiples: tuple[Multiple, ...]


@dataclass(frozen=True)
class LeadingTerm(Proof):
    """The leading term as the small variable goes to 0 is positive by an identity of signs."""

    rule = "leading term"
    identity: SignIdentity


@dataclass(frozen=True)
class PrintedInputs(Proof):
    """The printed inputs, taken as exact, give the printed result within its rounding."""

    rule = "printed inputs"
    bits: int


@dataclass(frozen=True)
class Corners(Proof):
    """Two corners of the inputs' roundings (0 lower, 1 upper end) give results around the printed one."""

    rule = "corners of the roundings"
    below: tuple[int, ...]
    above: tuple[int, ...]
    bits: int


@dataclass(frozen=True)
class OutsideRounding(Proof):
    """No inputs within their roundings give the printed result."""

    rule = "outside the roundings"
    bits: int


@dataclass(frozen=True)
class ChosenMajorants(Proof):
    """One majorant of each factor whose product is within the bound."""

    rule = "chosen majorants"
    choice: tuple[int, ...]
    numbers: Proof


@dataclass(frozen=True)
class FourierBounds(Proof):
    """The mean and the amplitudes of the Fourier sums suffice."""

    rule = "Fourier sums"


@dataclass(frozen=True)
class EntryWitness(Proof):
    """Angles at which one entry leaves its bounds, above (or below, if ``lower``)."""

    rule = "witness of an entry"
    entry: int
    lower: bool
    point: Point
    bits: int = 192


@dataclass(frozen=True)
class BoxTree(Proof):
    """A tree of boxes of (q, e): in preorder, a digit for the side that is cut, a dot for a leaf."""

    rule = "tree of boxes"
    tree: str


@dataclass(frozen=True)
class RadialBounds(Proof):
    """Bounds of the parts of dV/dt in ‖e‖ alone: weights, μ, ν, boxes of some angles behind them, cuts."""

    rule = "bounds in ‖e‖"
    weights: tuple[Fraction, ...]
    inertia: Fraction
    lowest: Fraction
    angles: tuple[int, ...]
    tree: str
    cuts: tuple[Fraction, ...]


@dataclass(frozen=True)
class StateWitness(Proof):
    """An arm within the ranges and a state of it at which dV/dt > 0."""

    rule = "state"
    viscous: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]
    q: tuple[Fraction, ...]
    e: tuple[Fraction, ...]
    w: tuple[Fraction, ...]


@dataclass(frozen=True)
class DampingAbove(Proof):
    """κ and ε₀ with dV/dt < 0 everywhere (``decreasing``) while κ λmax(K_v) < bound fails (``numbers``)."""

    rule = "damping above the bound"
    factor: Fraction
    eps0: Fraction
    numbers: Proof
    decreasing: Proof


@dataclass(frozen=True)
class Application(Proof):
    """A theorem of the checker's list; its hypotheses are the claims that the certificate uses."""

    rule = "theorem"


@dataclass(frozen=True)
class EveryPart(Proof):
    """A proof of each part, in order."""

    rule = "every part"
    parts: tuple[Proof, ...]


@dataclass(frozen=True)
class OnePart(Proof):
    """A refutation of one part."""

    rule = "one part"
    part: int
    proof: Proof
