"""exp, sin, cos and h in sums and products of doubles, and how far each is from the real function.

x = k c + r with c = π/2 or ln 2, the whole number k nearest to x/c, and |r| ≤ c/2 (Cody and Waite): c is a
sum of four doubles, the first three so short that k times each is exact. Of r the Taylor polynomials are
taken; their remainders are below the first term that is left out, or twice it for exp.

References: (6) of ``reyes2019family``; reduction: ``muller2018handbook`` 10.3.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from heapq import heapify, heappop, heappush
from itertools import pairwise

from flint import arb

from lyapcheck.check.numbers.balls import power, precision
from lyapcheck.check.numbers.polynomials import dyadic
from lyapcheck.errors import argument_error
from lyapcheck.export.steps import BITS, TINY, Program, Rounded, Step, U, Unbounded, constant, upper
from lyapcheck.family.base import Family

SHORT = 22
"""Bits after the point of the first part of c, and as many more of the next two: times k all are exact."""
SINE, COSINE, EXP = 17, 16, 13
"""The highest powers of the polynomials."""
NEAR = math.asinh(1.0)
"""Below it powers of sinh x are taken, from it on those of 1/sinh x: neither grows."""
FLAT = 20.0
"""From this |x| on h is taken at it: what is left is 2e-17 and less."""
WRITTEN = ("hyperbolic", "tanh")
MOST_BOXES = 6_000


@lru_cache(maxsize=1)
def constants() -> tuple[arb, arb]:
    """π/2 and ln 2."""
    with precision(2 * BITS):
        return arb.pi() / 2, arb(2).log()


@dataclass(frozen=True)
class Reduction:
    """x − k c in doubles.

    Args:
        c: π/2 or ln 2.
        inverse: the double nearest to 1/c.
        parts: four doubles whose sum is nearly c.
    """

    c: arb
    inverse: float
    parts: tuple[float, ...]

    def reach(self, largest: arb) -> tuple[arb, arb]:
        """For |x| ≤ ``largest``: bounds of |k| and of |x − k c|.

        k is x · (1/c) ± ½ without its fraction, three roundings: |k − x/c| ≤ ½ + 4 u |x/c| + 2 u.
        """
        turns = largest / self.c
        return upper(turns + 1), upper(self.c * (arb(0.5) + turns * (4 * U) + 2 * U))

    def error(self, largest: arb) -> arb:
        """A bound of |computed − (x − k c)|: what products and subtractions round, and what c lacks."""
        k, left = self.reach(largest)
        rest, wrong = self.c, arb(0)
        for part in self.parts:
            digits = Fraction(part).numerator
            # below 2^53 all whole numbers up to k times this double are doubles
            if not arb(digits // (digits & -digits)) * k < arb(2) ** 53:
                wrong = wrong + U * k * part + TINY
            rest = rest - arb(part)
            wrong = upper(wrong + U * (left + k * abs(rest) + wrong) + TINY)
        return upper(wrong + k * abs(rest))


@lru_cache(maxsize=2)
def reduction(number: int) -> Reduction:
    """That of π/2 (0), or of ln 2 (1)."""
    c, parts = constants()[number], []
    rest = dyadic(c.mid())
    for place in (SHORT, 2 * SHORT, 3 * SHORT):
        part = Fraction(math.floor(rest * 2**place), 2**place)
        parts.append(float(part))
        rest -= part
    return Reduction(c, float(1 / c), (*parts, float(rest)))


@dataclass(frozen=True)
class Kernel:
    """Some outputs of a program, by the C place that takes each; ``letter`` begins the names of its steps."""

    program: Program
    outputs: Mapping[str, Step]
    letter: str = "t"

    @property
    def reads(self) -> list[str]:
        return [rest[0] for kind, *rest in self.program.steps if kind == "read"]

    def rounded(self, **given: Rounded) -> list[Rounded]:
        return self.program.run(list(self.outputs.values()), given, Rounded.constant)

    def text(self, indent: str = "    ") -> str:
        return self.program.text(self.outputs, indent, self.letter)


def _horner(z: Step, coefficients: Sequence[Fraction]) -> Step:
    *rest, last = coefficients
    total = z.of.number(last)
    for coefficient in reversed(rest):
        total = total * z + coefficient
    return total


def _terms(first: int, last: int, step: int) -> list[Fraction]:
    """1/k!, of alternating signs where every second power is left out."""
    powers = range(first, last + 1, step)
    return [Fraction((-1) ** (i + 1) if step == 2 else 1, math.factorial(k)) for i, k in enumerate(powers)]


@lru_cache(maxsize=1)
def sine_and_cosine() -> Kernel:
    """sin r and cos r from r."""
    r = Program().read("r")
    z = r * r
    sine = r + r * z * _horner(z, _terms(3, SINE, 2))
    return Kernel(r.of, {"sine": sine, "cosine": 1 + z * _horner(z, _terms(2, COSINE, 2))})


@lru_cache(maxsize=1)
def exp_less_one() -> Kernel:
    """exp r − 1 from r."""
    r = Program().read("r")
    return Kernel(r.of, {"const double part": r + r * r * _horner(r, _terms(2, EXP, 1))}, "a")


@lru_cache(maxsize=1)
def scaled() -> Kernel:
    """exp(k ln 2 + r) − 1 from ``scale`` = 2ᵏ and ``part`` = exp r − 1."""
    scale = Program().read("scale")
    return Kernel(scale.of, {"const double g": scale * scale.of.read("part") + (scale - 1)}, "b")


def angle_error(largest: arb) -> arb:
    """A bound of the errors of sine and cosine at all |x| ≤ ``largest``.

    Turning by whole quarters is exact. The Taylor series alternate and fall for |r| ≤ 1.
    """
    of = reduction(0)
    _, left = of.reach(largest)
    r = arb(0).union(left).union(-left)
    errors = [out.error for out in sine_and_cosine().rounded(r=Rounded(r, of.error(largest)))]
    left_out = [left**k / math.factorial(k) for k in (SINE + 2, COSINE + 2)]
    return upper((errors[0] + left_out[0]).max(errors[1] + left_out[1]))


# --- h, on |x| up to where it is flat in doubles, and how far the computed one is from it.


@dataclass(frozen=True)
class Errors:
    """Bounds of |computed h − h| over all finite doubles.

    Args:
        exact: where the argument is the double itself.
        rounded: where it is the sum of two doubles, rounded once.
    """

    exact: arb
    rounded: arb


Box = tuple[arb, arb, int]
"""Two ends of |x|, and k for the hyperbolic family."""


class Saturation:
    """h_m from g = exp|x| − 1: sinh = ½ (g + g/(1 + g)), cosh = ½ (1 + g + 1/(1 + g)).

    h_m = cosh sinh^(2m−1)/(1 + sinh^(2m)), or with s = 1/sinh: cosh s/(1 + s^(2m)); no power exceeds 1.

    Raises:
        InputError: a family that is not written in C.
    """

    def __init__(self, family: Family) -> None:
        if family.name not in WRITTEN:
            why = "has a torque without bound" if not family.bounded else "has no formula in C here"
            repair = f"export gains of one of: {', '.join(WRITTEN)}"
            raise argument_error("family", family.name, why, repair)
        self.family, m = family, family.m or 1
        g = Program().read("g")
        e = 1 + g
        sinh, cosh = Fraction(1, 2) * (g + g / e), Fraction(1, 2) * (e + 1 / e)
        z, s = sinh * sinh, 1 / sinh
        low = z if m == 1 else z * power(z, m - 1)
        rise = cosh * sinh if m == 1 else cosh * sinh * power(z, m - 1)
        self.near = Kernel(g.of, {"y": rise / (1 + low)}, "c")
        self.far = Kernel(g.of, {"y": cosh * s / (1 + power(s * s, m))}, "d")

    def start(self) -> list[Box]:
        """For each k the |x| that it may come of, cut at `NEAR`."""
        of, flat = reduction(1), arb(FLAT)
        turns, left = of.reach(flat)
        boxes: list[Box] = []
        for k in range(math.floor(float(turns)) + 1):
            low, high = (k * of.c - left).lower().max(arb(0)), upper(k * of.c + left).min(flat)
            cut = arb(NEAR)
            ends = [low, cut, high] if low < cut < high else [low, high]
            boxes += [(a, b, k) for a, b in pairwise(ends) if a <= b]
        return boxes

    def computed(self, box: Box) -> Rounded:
        """By the branch that |x| takes; no box of `start` has `NEAR` inside."""
        low, high, k = box
        of, a, scale = reduction(1), low.union(high), Rounded(arb(2) ** k, arb(0))
        r = a - k * of.c
        (part,) = exp_less_one().rounded(r=Rounded(r, of.error(arb(FLAT))))
        left_out = 2 * r.abs_upper() ** (EXP + 1) / math.factorial(EXP + 1)
        (g,) = scaled().rounded(scale=scale, part=Rounded(r.expm1(), upper(part.error + left_out)))
        kernel = self.near if high <= NEAR else self.far
        return kernel.rounded(g=Rounded(a.expm1(), g.error))[0]

    def tail(self, low: arb) -> arb:
        """coth x/(1 + s^(2m)) with s ≤ 1."""
        return (1 / (1 + low.csch() ** 2)).union(low.coth())

    def text(self) -> str:
        return HYPERBOLIC.format(
            reduced=_reduced("a", reduction(1)),
            part=exp_less_one().text(),
            g=scaled().text(),
            near=constant(NEAR),
            low=self.near.text(" " * 8),
            high=self.far.text(" " * 8),
        )

    def errors(self) -> Errors:
        """Bounds by boxes; the worst is halved until it is within a quarter of what its middle shows.

        Soundness: for a rounded argument x̂ = x (1 + δ), |δ| ≤ u, h(x̂) − h(x) is h' in between times δ x.

        Raises:
            Unbounded: not so within `MOST_BOXES`.
        """
        flat = arb(FLAT)
        range_beyond = self.tail(flat * (1 - 4 * U))
        beyond = upper(2 * range_beyond.rad())
        boxes = [self._judged(box) for box in self.start()]
        heapify(boxes)
        while len(boxes) < MOST_BOXES:
            worst, (low, high, k), _, _ = boxes[0]
            middle = arb(((low + high) / 2).mid())
            if -worst <= 1.25 * -self._judged((middle, middle, k))[0]:
                break
            heappop(boxes)
            for half in ((low, middle, k), (middle, high, k)):
                heappush(boxes, self._judged(half))
        if math.isinf(boxes[0][0]):
            raise Unbounded("h has no bound of rounding")
        return Errors(*(upper(max(box[i] for box in boxes) + beyond) for i in (2, 3)))

    def _judged(self, box: Box) -> tuple[float, Box, arb, arb]:
        """The negative of the second bound, the box, and both bounds."""
        low, high, _ = box
        a = low.union(high) * arb(1, 4 * U)
        slope = upper(self.family.ball_dh(a).abs_upper() * a.abs_upper() * (U * (1 + 4 * U)))
        try:
            error = self.computed(box).error
        except Unbounded:
            error = arb("inf")
        return -float(error + slope), box, error, upper(error + slope)


HYPERBOLIC = """\
    double k;
    const double r = {reduced};
{part}
    const double scale = (double)(1L << (int)k);
{g}
    double y;
    if (a < {near}) {{
{low}
    }} else {{
{high}
    }}"""


def _reduced(x: str, of: Reduction) -> str:
    return f"reduced({x}, {', '.join(map(constant, (of.inverse, *of.parts)))}, &k)"


def sine_text() -> str:
    """The C statements that put sin x and cos x, but for quarters of a turn, into their places."""
    return f"    const double r = {_reduced('x', reduction(0))};\n{sine_and_cosine().text()}"
