"""The inertia matrix, gravity and Christoffel symbols of an arm over boxes of angles."""

from __future__ import annotations

from functools import cached_property
from itertools import product

import numpy as np

from lyapcheck._types import Array
from lyapcheck.check.numbers.harmonics import Harmonics, christoffel, derivative, harmonics
from lyapcheck.constants.torus import Torus
from lyapcheck.robots import trig
from lyapcheck.robots.plant import Plant


class ArmHarmonics:
    """The polynomials of an arm, its parameters at nominal values, ready for boxes."""

    def __init__(self, model: Plant) -> None:
        self.n = n = model.n
        fixed = model.fixed()
        self.places = [(i, j) for i in range(n) for j in range(i + 1)]
        self.harmonics: dict[tuple[int, int], Harmonics] = {
            (i, j): harmonics(trig.to_terms(fixed.mass[i][j]), n) for i, j in self.places
        }
        potential = harmonics(trig.to_terms(fixed.potential), n)
        self.gravity = [derivative(potential, i) for i in range(n)]
        self.mass = Torus([self.harmonics[place] for place in self.places], n)

    @cached_property
    def triples(self) -> list[tuple[int, int, int]]:
        """The i, j, k with k ≤ j of the Christoffel symbols, in the order of ``symbols``."""
        return [(i, j, k) for i, j, k in product(range(self.n), repeat=3) if k <= j]

    @cached_property
    def symbols(self) -> Torus:
        """The Christoffel symbols c_ijk = c_ikj with k ≤ j."""
        joints = range(self.n)
        known = christoffel([[self.harmonics[max(i, j), min(i, j)] for j in joints] for i in joints])
        return Torus([known.get(place, {}) for place in self.triples], self.n)

    def matrix(self, entries: Array) -> Array:
        """The symmetric matrices of the entries on and below the diagonal."""
        result = np.empty((*entries.shape[:-1], self.n, self.n))
        for column, (i, j) in enumerate(self.places):
            result[..., i, j] = result[..., j, i] = entries[..., column]
        return result

    def tensor(self, entries: Array) -> Array:
        """The c_ijk of the symbols with k ≤ j, (..., n, n, n)."""
        result = np.empty((*entries.shape[:-1], self.n, self.n, self.n))
        for column, (i, j, k) in enumerate(self.triples):
            result[..., i, j, k] = result[..., i, k, j] = entries[..., column]
        return result
