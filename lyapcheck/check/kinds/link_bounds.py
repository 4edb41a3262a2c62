"""Bounds of M(q) and its rates along the links, and with boxes of e a proof of dV/dt < 0.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.loop import storage
from lyapcheck.check.loop.boxes import Box, leaves
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.closed_loop import ClosedLoop, RateProof, masses_at_corners
from lyapcheck.check.loop.error_form import SCALE, BoxForm
from lyapcheck.check.loop.links import makes
from lyapcheck.check.loop.storage import Shown
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.refusal import require

BITS = 64


@dataclass(frozen=True)
class LinkBounds(RateProof):
    """Bounds of M and its rates along the links, and boxes of e, untrusted.

    Args:
        arms: the links at each corner of the ranges of the parameters, in the order of ``corners_of``.
        inertia: M ≼ U, kg·m².
        rising: ½ ∂M/∂q_j ≼ Q_j for the second and each further joint, kg·m².
        falling: −½ ∂M/∂q_j ≼ Q_j, with the same Q_j.
        tree: boxes of |e_1|, …, |e_n|, each from 0 to ``farthest`` of the closed loop.
        scales: for each box in turn the multiplier l and the expected sizes of w and of p, as signs.
    """

    rule = "bounds along the links"
    arms: tuple[tuple[RigidLink, ...], ...]
    inertia: Shown
    rising: tuple[Shown, ...]
    falling: tuple[Shown, ...]
    tree: str
    scales: str

    def require_shown(self, loop: ClosedLoop) -> None:
        """Judge links, bounds and boxes one after the other."""
        n = loop.n
        require(not loop.coupling, "weights", loop.coupling, "must be none")
        require(loop.admissible, "gains, friction or ε₀", "", "must be positive, M = Mᵀ")
        masses = masses_at_corners(loop.arm.mass, loop.parameters)
        made = len(self.arms) == len(masses) and all(map(makes, self.arms, masses))
        require(made, "links", len(self.arms), "do not make M(q) at the corners of its ranges")
        sizes = {len(self.rising), len(self.falling)}
        require(sizes == {n - 1}, "rates", sizes, f"must be bounded for {n - 1} joints")
        require(self._bounds_shown(), "forms", "", "do not show the bounds of M and its rates")
        require(self._boxes_shown(loop), "boxes", self.tree.count("."), "do not show dV/dt < 0 at every e")

    def _bounds_shown(self) -> bool:
        same = all(up.prices == down.prices for up, down in zip(self.rising, self.falling, strict=True))
        energy = [storage.energy(links, 1) for links in self.arms]
        return (
            same
            and self.inertia.holds(energy, 2)
            and all(
                bound.holds([storage.rate_of_mass(links, 1 + k, sign) for links in self.arms], 4)
                for sign, bounds in ((1, self.rising), (-1, self.falling))
                for k, bound in enumerate(bounds)
            )
        )

    def _boxes_shown(self, loop: ClosedLoop) -> bool:
        size = 1 + 2 * loop.n
        count = self.tree.count(".")
        if len(self.scales) != size * count or not set(self.scales) <= set(SCALE):
            return False
        start: Box = tuple((0.0, far) for far in loop.farthest)
        rows = (self.scales[k * size : (k + 1) * size] for k in range(count))
        with precision(BITS):
            form = BoxForm(loop, self.inertia.prices, [bound.prices for bound in self.rising])
            return all(form.proves(box, row) for box, row in zip(leaves(start, self.tree), rows, strict=True))
