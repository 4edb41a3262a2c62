"""M and the potential as a source prints them: sums of a decimal times a product of known factors.

A term is ``[2, "b s2 s23"]``: a decimal, then factors separated by spaces. A factor is the sine or
cosine of a joint angle (``s2``, ``c1``) or of a sum of joint angles (``s23`` = sin(q2 + q3)), or the name
of an entry of ``[numbers]``; ``^2`` raises it to a power. Nothing else is understood, and nothing is
evaluated as code.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Any, ClassVar

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.files.toml import KeyPath
from lyapcheck.robots import trig
from lyapcheck.robots.fields import ROTOR, ArmFields, JointEntry, Number, read_joints

_FACTOR = re.compile(r"([A-Za-z][A-Za-z0-9_]*)(?:\^([1-9]))?")
_ANGLE = re.compile(r"[sc][0-9]+")
_MOST_FACTORS = 12
_MOST_ANGLES = 16
_MOST_TERMS = 1000

Term = tuple[Fraction, tuple[tuple[str, int], ...]]
Terms = tuple[Term, ...]


def is_angle(name: str) -> bool:
    """Whether the name is that of a sine or cosine, and so cannot name a number."""
    return _ANGLE.fullmatch(name) is not None


def read_terms(fields: ArmFields, key: str, n: int, numbers: Collection[str]) -> Terms:
    """The terms behind a key; what is wrong with them is noted."""
    terms = enumerate(term_list(fields, key))
    read = [read_term(fields, (*fields.path, key, i), term, n, numbers) for i, term in terms]
    return tuple(term for term in read if term is not None)


def term_list(fields: ArmFields, key: str) -> list[Any]:
    """The list behind a key, its items not yet looked at; empty where it is bad."""
    value = fields.raw(key, required=True)
    if value is None:
        return []
    if not isinstance(value, list) or len(value) > _MOST_TERMS:
        rule = f"must be a list of at most {_MOST_TERMS} terms"
        fields.fail(key, rule, f'write {key} = [[2.351, ""], [0.168, "c2"]]')
        return []
    return value


def read_term(
    fields: ArmFields, path: KeyPath, term: object, n: int, numbers: Collection[str]
) -> Term | None:
    """One term, ``None`` where it is bad."""
    if not isinstance(term, list) or len(term) != 2 or not isinstance(term[1], str):
        fields.notes.fail(path, term, "must be a decimal and a text of factors", 'write [0.168, "c2"]')
        return None
    coefficient = fields.decimal((*path, 0), term[0])
    factors = [_FACTOR.fullmatch(word) for word in term[1].split()]
    rule = _broken_rule(term[1], factors, n, numbers)
    if rule:
        known = ", ".join(["s1", "c1", *numbers])
        fields.notes.fail((*path, 1), term[1], rule, f"use factors like {known}, separated by spaces")
    if coefficient is None or rule:
        return None
    return coefficient, tuple((match[1], int(match[2] or 1)) for match in factors if match)


def _broken_rule(text: str, factors: list[re.Match[str] | None], n: int, numbers: Collection[str]) -> str:
    if len(factors) > _MOST_FACTORS:
        return f"has more than {_MOST_FACTORS} factors"
    angles = 0
    for factor, word in zip(factors, text.split(), strict=True):
        if factor is None:
            return f"{word!r} is no factor"
        name, power = factor[1], int(factor[2] or 1)
        angles += power * len(name[1:]) if is_angle(name) else 0
        if is_angle(name) and not all(1 <= int(digit) <= n for digit in name[1:]):
            return f"{word!r} speaks of a joint that this arm of {n} does not have"
        if not is_angle(name) and name not in numbers:
            return f"{word!r} is neither a sine, a cosine nor an entry of [numbers]"
    return f"adds up more than {_MOST_ANGLES} angles" if angles > _MOST_ANGLES else ""


def polynomial(terms: Terms, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> fmpq_mpoly:
    """The sum of the terms, in normal form."""
    result = trig.constant(ring, 0)
    for coefficient, factors in terms:
        term = trig.constant(ring, coefficient)
        for name, power in factors:
            factor = _angle(name, ring) if is_angle(name) else numbers[name]
            term = trig.normal_form(term * factor**power)
        result += term
    return result


def _angle(name: str, ring: fmpq_mpoly_ctx) -> fmpq_mpoly:
    """Sine or cosine of the sum of the joint angles whose numbers follow the letter."""
    n = trig.joint_count(ring)
    sine, cosine = trig.constant(ring, 0), trig.constant(ring, 1)
    for digit in name[1:]:
        s, c = ring.gen(int(digit) - 1), ring.gen(n + int(digit) - 1)
        sine, cosine = sine * c + cosine * s, cosine * c - sine * s
    return trig.normal_form(sine if name[0] == "s" else cosine)


# --- C(q, q̇) and g(q) as a source prints them: to be compared with those of M and the potential, never used.
#
# Terms are those of `lyapcheck.robots.printed`; a term of C has besides one rate ``w1``, ``w2``, …::
#
#     [printed]
#     C11 = [[-0.168, "s2 w2"]]
#     C12 = [[-0.084, "s2 w2"]]
#     C21 = [[0.084, "s2 w1"]]
#     C22 = []
#     g1 = [[38.46501, "s1"], [1.82466, "s12"]]
#     g2 = [[1.82466, "s12"]]


_RATE = re.compile(r"w([1-9])")


@dataclass(frozen=True)
class PrintedTorques:
    """What is printed, as plain terms.

    Args:
        coriolis: the terms of C_ij that the rate of joint k multiplies, by (i, j, k); empty where none are.
        gravity: the terms of each g_i; empty where they are not printed.
    """

    coriolis: Mapping[tuple[int, int, int], Terms]
    gravity: tuple[Terms, ...]


def read_torques(fields: ArmFields, n: int, numbers: Collection[str]) -> PrintedTorques:
    """The ``[printed]`` table of an arm with n joints; problems are noted in ``fields``."""
    joints = range(n)
    coriolis: dict[tuple[int, int, int], Terms] = {}
    if any(key.startswith("C") for key in fields.data):
        for i, j in product(joints, repeat=2):
            for k, term in _rates(fields, f"C{i + 1}{j + 1}", n, numbers):
                coriolis[i, j, k] = (*coriolis.get((i, j, k), ()), term)
    wanted = any(key.startswith("g") for key in fields.data)
    gravity = tuple(read_terms(fields, f"g{i + 1}", n, numbers) for i in joints) if wanted else ()
    if not coriolis and not wanted:
        fields.notes.fail(fields.path, None, "has no C11 … and no g1 …", "give the terms that are printed")
    return PrintedTorques(coriolis, gravity)


def _rates(fields: ArmFields, key: str, n: int, numbers: Collection[str]) -> Iterator[tuple[int, Term]]:
    """The terms of one entry of C, each with the joint whose rate it has."""
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
        read = read_term(fields, path, [term[0], rest], n, numbers)
        if read is not None:
            yield rates[0], read


# --- The arm in print.


MOST_PRINTED = 9
"""A name like c12 is the cosine of q1 + q2, so that joints have one digit."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,40}")


@dataclass(frozen=True)
class PrintedPlan:
    """M, on and above its diagonal, and the potential in print, with the numbers that they name."""

    place: ClassVar[str] = "model"
    joints: list[JointEntry]
    numbers: dict[str, Number]
    mass: Mapping[tuple[int, int], Terms]
    potential: Terms
    torques: PrintedTorques | None

    @property
    def used(self) -> set[str]:
        terms = (term for entry in (*self.mass.values(), self.potential) for term in entry)
        rotors = {name for joint in self.joints for name in joint.rotors}
        return {name for _, factors in terms for name, _ in factors} | rotors

    def build(self, numbers: Mapping[str, Number], parameters: tuple[str, ...]) -> trig.Polynomials:
        n = len(self.joints)
        ring = trig.trig_ring(n, parameters)
        polys = {key: trig.constant(ring, number.value) for key, number in numbers.items()}
        polys |= dict(zip(parameters, ring.gens()[2 * n :], strict=True))
        rows = {place: polynomial(terms, ring, polys) for place, terms in self.mass.items()}
        for i, joint in enumerate(self.joints):
            rows[i, i] += polys.get(f"{joint.name}{ROTOR}", 0)
        mass = tuple(tuple(rows[min(i, j), max(i, j)] for j in range(n)) for i in range(n))
        return trig.Polynomials(mass, polynomial(self.potential, ring, polys), parameters)


def read_model(
    top: ArmFields,
    tables: list[ArmFields],
    numbers: ArmFields | None,
    model: ArmFields,
    torques: ArmFields | None,
) -> PrintedPlan:
    """The arm of ``[model]`` and ``[[joints]]``; problems are noted."""
    joints = read_joints(top, "joints", tables, MOST_PRINTED)
    rotors = {name: number for joint in joints for name, number in joint.rotors.items()}
    taken = {name for joint in joints for name in joint.numbers()} | set(rotors)
    names, entries = [] if numbers is None else list(numbers.data), dict[str, Number]()
    for name in names:
        assert numbers is not None
        entry = numbers.quantity(name, "")
        if not _NAME.fullmatch(name) or is_angle(name):
            rule = "must be letters, digits and underscores, and not look like a sine or cosine (s1, c23)"
            numbers.fail(name, rule, "rename it")
        elif name in taken:
            numbers.fail(name, "is also the name of a number of a joint", "rename it")
        entries |= {} if entry is None else {name: entry}
    n = min(len(joints), MOST_PRINTED)
    upper = [(i, j) for i in range(n) for j in range(i, n)]
    mass = {(i, j): read_terms(model, f"M{i + 1}{j + 1}", n, names) for i, j in upper}
    potential = read_terms(model, "potential", n, names)
    for i, j in upper:
        mirror = f"M{j + 1}{i + 1}"
        if i != j and mirror in model.data:
            model.raw(mirror)
            model.fail(mirror, "M is symmetric: its entries below the diagonal are not given", "remove it")
    compared = None if torques is None else read_torques(torques, n, names)
    for table in [*tables, model, *([] if torques is None else [torques])]:
        table.close()
    return PrintedPlan(joints, entries | rotors, mass, potential, compared)
