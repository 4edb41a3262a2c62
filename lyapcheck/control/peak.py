"""γ_m between two integers over a power of two, in integers alone: enough to decide all but equality.

The peak of h_m is where u = sinh²x is the only positive root of P(u) = u^m − 2m u − (2m − 1), for m ≥ 2 (see
``lyapcheck.check.numbers.critical``), and there γ_m = (2m(1 + u) − 1)/(2m √(u(1 + u))).

Soundness: Newton's method only proposes u; it lies between two numbers at which P has certainly opposite
signs, as powers are taken twice, rounded down and rounded up.

References: ``reyes2019family`` (6), (7).
"""

from __future__ import annotations

from functools import lru_cache
from math import isqrt

_SPARE = 32


@lru_cache(maxsize=4096)
def gamma_between(m: int, bits: int) -> tuple[int, int]:
    """Integers a ≤ γ_m·2^bits ≤ b that are a few units apart, for m ≥ 1."""
    one = 1 << bits
    if m == 1:
        return one, one
    low, high = _peak_between(m, bits)
    root_low, root_high = isqrt(low * (one + low)), isqrt(high * (one + high)) + 1
    top_low, top_high = (2 * m * (one + u) - one for u in (low, high))
    return (top_low << bits) // (2 * m * root_high), -((-top_high << bits) // (2 * m * root_low))


def _peak_between(m: int, bits: int) -> tuple[int, int]:
    """Integers a < u·2^bits < b for the root u of P."""
    work = bits + _SPARE + 2 * m.bit_length()
    u, reach = _newton(m, work), 1 << (work - bits)
    while not (_rises(m, u - reach, work) and _falls(m, u + reach, work)):
        reach *= 4
    return (u - reach) >> (work - bits), ((u + reach) >> (work - bits)) + 1


def _newton(m: int, work: int) -> int:
    """Near u·2^work; nothing is promised."""
    near = 2.0
    for _ in range(60):
        near = (2 * m * near + 2 * m - 1) ** (1 / m)
    u = int(near * 2**52) << (work - 52)
    for _ in range(work.bit_length() - 4):
        power = _power(u, m, work, up=False)
        slope = (m * power << work) // u - (2 * m << work)
        u -= ((power - 2 * m * u - ((2 * m - 1) << work)) << work) // slope
    return u


def _rises(m: int, u: int, work: int) -> bool:
    """Whether P < 0 for certain."""
    return _power(u, m, work, up=True) < 2 * m * u + ((2 * m - 1) << work)


def _falls(m: int, u: int, work: int) -> bool:
    """Whether P > 0 for certain."""
    return _power(u, m, work, up=False) > 2 * m * u + ((2 * m - 1) << work)


def _power(u: int, m: int, work: int, up: bool) -> int:
    """u^m in units of 2^-work, every product rounded the same way."""
    carry = (1 << work) - 1 if up else 0
    result, base = 1 << work, u
    while m:
        if m & 1:
            result = (result * base + carry) >> work
        m >>= 1
        if m:
            base = (base * base + carry) >> work
    return result
