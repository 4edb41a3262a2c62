"""Proposing what shows a bound of k_c of an arm whose M(q) is written out: relations of products of rates.

At each posture the least bound that a matrix of rates and products shows is a semidefinite program in one
relation N; for two and three joints it is k_c there, as forms of degree four in two and three variables that
are not negative are sums of squares. The relations are fitted as for a chain, see ``storage/postures``.

References: `lyapcheck.check.loop.symbols`; sums of squares, ``hilbert1888darstellung``.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from lyapcheck.check.kinds.coriolis_below import MOST_ANGLES, MOST_JOINTS, ProductsOfRates
from lyapcheck.check.loop.control_points import nodes
from lyapcheck.check.loop.head import DEGREE
from lyapcheck.check.loop.inertia import Inertia
from lyapcheck.check.loop.symbols import Symbols
from lyapcheck.constants.storage.postures import Postures, exact_rows


def products_below(inertia: Inertia, bound: Fraction) -> ProductsOfRates | None:
    """What shows that k_c is below a bound; ``None`` where nothing is found, or joints are too many."""
    symbols, kappa = Symbols(inertia), float(bound)
    angles, degree = len(symbols.angles), symbols.degree
    if not (2 <= inertia.n <= MOST_JOINTS and 1 <= angles <= MOST_ANGLES and degree <= DEGREE and kappa > 0):
        return None
    values = [(symbols.power(q), symbols.square) for q in nodes(degree, angles)]
    shown = Postures(values, degree, angles).shown(kappa, np.array([[-kappa]]))
    return None if shown is None else ProductsOfRates(exact_rows(shown[0]), *shown[1:])
