"""C(q, q̇) and g(q) as a source prints them: to be compared with those of M and the potential, never used.

Terms are those of `lyapcheck.robots.printed`; a term of C has besides one rate ``w1``, ``w2``, …::

    [printed]
    C11 = [[-0.168, "s2 w2"]]
    C12 = [[-0.084, "s2 w2"]]
    C21 = [[0.084, "s2 w1"]]
    C22 = []
    g1 = [[38.46501, "s1"], [1.82466, "s12"]]
    g2 = [[1.82466, "s12"]]
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.robots.fields import ArmFields
from lyapcheck.robots.printed import Terms, names_of, polynomial, read_term, read_terms, term_list

_RATE = re.compile(r"w([1-9])")
Tensor = tuple[tuple[tuple[fmpq_mpoly, ...], ...], ...]


@dataclass(frozen=True)
class PrintedTorques:
    """What is printed, as plain terms.

    Args:
        coriolis: the terms of C_ij that the rate of joint k multiplies, by (i, j, k); empty where none are.
        gravity: the terms of each g_i; empty where they are not printed.
    """

    coriolis: Mapping[tuple[int, int, int], Terms]
    gravity: tuple[Terms, ...]

    def names(self) -> set[str]:
        """The entries of ``[numbers]`` that occur."""
        return names_of([*self.coriolis.values(), *self.gravity])

    def symbols(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly], n: int) -> Tensor:
        """p_ijk with C(q, q̇)_ij = Σ_k p_ijk q̇_k, in normal form."""
        joints = range(n)
        return tuple(
            tuple(
                tuple(polynomial(self.coriolis.get((i, j, k), ()), ring, numbers) for k in joints)
                for j in joints
            )
            for i in joints
        )

    def weights(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> tuple[fmpq_mpoly, ...]:
        """g(q) in normal form."""
        return tuple(polynomial(terms, ring, numbers) for terms in self.gravity)


def read_torques(fields: ArmFields, n: int, numbers: Collection[str]) -> PrintedTorques:
    """The ``[printed]`` table of an arm with n joints; problems are noted in ``fields``."""
    joints = range(n)
    coriolis: dict[tuple[int, int, int], Terms] = {}
    if any(key.startswith("C") for key in fields.data):
        for i in joints:
            for j in joints:
                for k, terms in _rates(fields, f"C{i + 1}{j + 1}", n, numbers).items():
                    coriolis[i, j, k] = terms
    wanted = any(key.startswith("g") for key in fields.data)
    gravity = tuple(read_terms(fields, f"g{i + 1}", n, numbers) for i in joints) if wanted else ()
    if not coriolis and not wanted:
        fields.notes.fail(fields.path, None, "has no C11 … and no g1 …", "give the terms that are printed")
    return PrintedTorques(coriolis, gravity)


def _rates(fields: ArmFields, key: str, n: int, numbers: Collection[str]) -> dict[int, Terms]:
    """The terms of one entry of C by the joint whose rate they have."""
    result: dict[int, Terms] = {}
    for place, term in enumerate(term_list(fields, key)):
        path = (*fields.path, key, place)
        words = (
            term[1].split() if isinstance(term, list) and len(term) == 2 and isinstance(term[1], str) else []
        )
        rates = [int(match[1]) - 1 for word in words if (match := _RATE.fullmatch(word))]
        if len(rates) != 1 or rates[0] >= n:
            rule = f"must have exactly one of the rates w1 … w{n}"
            fields.notes.fail(path, term, rule, 'write [-0.168, "s2 w2"]')
            continue
        rest = " ".join(word for word in words if not _RATE.fullmatch(word))
        read: tuple[Fraction, tuple[tuple[str, int], ...]] | None = read_term(
            fields, path, [term[0], rest], n, numbers
        )
        if read is not None:
            result[rates[0]] = (*result.get(rates[0], ()), read)
    return result
