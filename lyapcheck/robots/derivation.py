"""M and the potential of a chain: derived, or read from a cache of what was derived before."""

from __future__ import annotations

from collections.abc import Sequence

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.robots.links import Link, Vector, chain


def derive(
    ring: fmpq_mpoly_ctx, links: Sequence[Link], gravity: Vector
) -> tuple[tuple[tuple[fmpq_mpoly, ...], ...], fmpq_mpoly]:
    """As `lyapcheck.robots.links.chain`."""
    return chain(ring, links, gravity)
