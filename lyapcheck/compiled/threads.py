"""Work split over the processors; compiled code runs without the interpreter's lock."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

_A_FEW = 4
"""Shares for each processor: a processor that others use as well then holds nobody up for long."""


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def over_shares(work: Callable[[int, int], int], count: int, unit: int = 1) -> int:
    """The sum of ``work(start, stop)`` over consecutive shares of ``range(count)``, a few to a processor.

    Args:
        work: does its share.
        count: how much there is.
        unit: shares are whole multiples of it, except the last.
    """
    helpers = processors() - 1
    shares = _shares(count, _A_FEW * (helpers + 1), unit) if helpers else [(0, count)]
    if len(shares) == 1:
        return work(*shares[0])
    open_shares = deque(shares)

    def drain() -> int:
        total = 0
        while True:
            try:
                share = open_shares.popleft()
            except IndexError:
                return total
            total += work(*share)

    with ThreadPoolExecutor(min(helpers, len(shares) - 1)) as pool:
        others = [pool.submit(drain) for _ in range(helpers)]
        return drain() + sum(other.result() for other in others)


def _shares(count: int, parts: int, unit: int) -> list[tuple[int, int]]:
    size = max(1, -(-count // (parts * unit))) * unit
    return [(start, min(start + size, count)) for start in range(0, count, size)] or [(0, count)]
