"""M and the potential as a source prints them: sums of a decimal times a product of known factors.

A term is ``[2, "b s2 s23"]``: a decimal, then factors separated by spaces. A factor is the sine or
cosine of a joint angle (``s2``, ``c1``) or of a sum of joint angles (``s23`` = sin(q2 + q3)), or the name
of an entry of ``[numbers]``; ``^2`` raises it to a power. Nothing else is understood, and nothing is
evaluated as code.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.robots import trig

_FACTOR = re.compile(r"([A-Za-z][A-Za-z0-9_]*)(?:\^([1-9]))?")
_ANGLE = re.compile(r"[sc][1-9]+")


class TermError(ValueError):
    """A factor of a printed term cannot be read; the message is the rule that it breaks."""


def is_angle(name: str) -> bool:
    """Whether the name is one of a sine or cosine, and so cannot name a number."""
    return _ANGLE.fullmatch(name) is not None


def monomial(text: str, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> fmpq_mpoly:
    """The product of the factors in the text, in normal form; 1 for an empty text.

    Raises:
        TermError: a factor that is no sine, cosine or known number.
    """
    product = trig.constant(ring, 1)
    for word in text.split():
        product = trig.normal_form(product * _factor(word, ring, numbers))
    return product


def _factor(word: str, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> fmpq_mpoly:
    match = _FACTOR.fullmatch(word)
    if match is None:
        raise TermError(f"{word!r} is not a factor")
    name, power = match[1], int(match[2] or 1)
    if is_angle(name):
        return _angle(name, ring) ** power
    if name not in numbers:
        raise TermError(f"{name!r} is neither a sine, a cosine nor an entry of [numbers]")
    return numbers[name] ** power


def _angle(name: str, ring: fmpq_mpoly_ctx) -> fmpq_mpoly:
    """Sine or cosine of the sum of the joint angles whose numbers follow the letter."""
    n = trig.joint_count(ring)
    sine, cosine = trig.constant(ring, 0), trig.constant(ring, 1)
    for digit in name[1:]:
        joint = int(digit) - 1
        if joint >= n:
            raise TermError(f"{name!r} speaks of joint {digit}, and the arm has {n}")
        s, c = ring.gen(joint), ring.gen(n + joint)
        sine, cosine = sine * c + cosine * s, cosine * c - sine * s
    return trig.normal_form(sine if name[0] == "s" else cosine)
