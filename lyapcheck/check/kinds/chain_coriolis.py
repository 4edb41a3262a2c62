"""C(q, x) of a chain of links: how large it is at most.

References: ``reyes2019family``, Property 2.6.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.chain import OfLinks
from lyapcheck.check.kinds.inertia import Bound, PostureWitness, dot, require_posture
from lyapcheck.check.loop import motion
from lyapcheck.check.loop.control_points import require_points
from lyapcheck.check.loop.head import DEGREE, DEGREE_ALONE
from lyapcheck.check.loop.storage import hinges
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.vectors import Algebra
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import Accepted, rule, verify


@dataclass(frozen=True)
class ChainCoriolisBelow(OfLinks, Bound):
    """‖C(q, x)y‖ <= high ‖x‖ ‖y‖ for the C of Christoffel symbols, all q, x and y; kg·m².

    That C(q, x)y is bilinear and symmetric in x and y; so is zᵀC(q, x)y for each z, and with it the largest
    value over unit vectors x, y is taken with y = ± x: ‖C(q, x)x‖ <= high ‖x‖² says the same.
    """

    high: Fraction

    def require_well_formed(self) -> None:
        """A chain, and a bound that is not negative."""
        super().require_well_formed()
        require(self.high >= 0, "high", self.high, "must not be negative")

    def text(self) -> str:
        """``‖C(q, x)y‖ ≤ high ‖x‖ ‖y‖ …``."""
        bound = f"‖C(q, x)y‖ ≤ {number_text(self.high)} ‖x‖ ‖y‖"
        return f"{bound} for all x, y, {self.over}; C by Christoffel symbols"

    def excess(self, at: PostureWitness) -> arb:
        """‖2 C(q, x)x‖² − (2 high ‖x‖²)²."""
        n = len(self.links)
        require_posture(at, n, ())
        require(len(at.x) == n and not at.y, "x", len(at.x), f"must have {n} entries, and y none")
        q, x = ([to_arb(value) for value in part] for part in (at.q, at.x))
        turns = [angle.sin() for angle in q], [angle.cos() for angle in q]
        chain, of = hinges(self.links), Algebra(to_arb)
        torques = [
            motion.coriolis_power(of, chain, *turns, [Fraction(int(i == k)) for k in range(n)], x)
            for i in range(n)
        ]
        return dot(torques, torques) - to_arb(4 * self.high**2) * dot(x, x) ** 2


MOST_FIRST, MOST_ALONE = 4, 5
"""First joints, with others behind them and without."""


@dataclass(frozen=True)
class MotionForms(Proof):
    """Positive definite matrices of monomials of the motion, see :func:`motion.shows`; untrusted.

    Args:
        kappa: the bound that they show, the stated one or a smaller one.
        joints: P and Q of each joint behind the first K.
        relations: of the products of the first K speeds, at each of the nodes of q_2, …, q_K; of which
            degree says their number.
        start: control points of each of the angles q_2, …, q_K to begin with.
        halvings: the angle, counted from 0, whose step is halved next.
    """

    rule = "forms of the motion"
    kappa: Fraction
    joints: tuple[tuple[motion.Gram, motion.Gram], ...]
    relations: tuple[tuple[Fraction, ...], ...]
    start: tuple[int, ...]
    halvings: tuple[int, ...]


@rule(ChainCoriolisBelow, MotionForms)
def by_motion(statement: ChainCoriolisBelow, proof: MotionForms) -> Accepted:
    """Soundness: 2 zᵀC(q, x)x ≤ κ(‖z‖² + ‖x‖⁴), κ ≤ high; for z along C(q, x)x, ‖z‖ = ‖x‖²."""
    require(proof.kappa <= statement.high, "kappa", proof.kappa, f"must be at most {statement.high}")
    if proof.kappa < statement.high:
        # what is seen once for the smallest bound serves for all of them, see ``each_once``
        return verify(replace(statement, high=proof.kappa), proof)
    n, start, halvings = len(statement.links), proof.start, proof.halvings
    first = n - len(proof.joints)
    require(n >= 2, "links", n, "must be two or more")
    most, least = (MOST_FIRST, DEGREE) if proof.joints else (MOST_ALONE, DEGREE_ALONE)
    require(2 <= first <= most, "joints", len(proof.joints), f"must leave 2 to {most} joints")
    rows = {(2 * degree + 1) ** (first - 1): degree for degree in range(least, DEGREE + 1)}
    known = len(proof.relations) in rows
    require(known, "relations", len(proof.relations), f"must be {' or '.join(map(str, rows))} rows")
    degree = rows[len(proof.relations)]
    require_points(start, halvings, degree, first - 1)
    links = hinges(statement.links)
    shown = motion.shows(links, proof.kappa, proof.joints, proof.relations, degree, start, halvings)
    require(shown, "forms", "", "do not show the bound")
    return Accepted("proved", "enclosure")
