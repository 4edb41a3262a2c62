"""What a bound by storage forms has to satisfy: one symmetric matrix a joint, to be positive semidefinite."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck.constants.storage.exact import Exact

Form = Any
"""A symmetric matrix in exact numbers or in doubles."""


@dataclass(frozen=True, eq=False)
class Step:
    """What happens at one joint, in its frame; w has d components and u has m.

    Args:
        carry: from the w of the joint before to that of this one at q = 0, d × d.
        push: (w, u) ↦ w', d × (d + m).
        cost: a form of w', d × d.
        price: a form of (w, u), (d + m) × (d + m).
        met: which components of (w, u) can differ from zero.
    """

    carry: Exact
    push: Exact
    cost: Exact
    price: Exact
    met: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Problem:
    """The steps, base first, and where they start.

    Args:
        steps: one a joint.
        start: w of the base, (d,); the condition there is κ ≥ s_1(X_1 start).
        forms: a basis of the forms of w that turns about a joint leave as they are.
        sign: −1 where the constant is an infimum: −κ then is its bound.
    """

    steps: Sequence[Step]
    start: Exact
    forms: Sequence[NDArray[np.float64]]
    sign: int = 1

    def taken(self, step: int, after: Form) -> Form:
        """What s_{k+1} or a cost, as a form of w', is as a form of (w, u)."""
        push = self.steps[step].push
        return push.T @ after @ push

    def brought(self, step: int, form: Form) -> Form:
        """The form s_k of w in the frame of joint k as one of w' of the joint before."""
        carry = self.steps[step].carry
        return carry.T @ form @ carry

    def slack(self, step: int, own: Form, after: Form | None, kappa: Any) -> Exact:
        """s_k + κ price − cost − s_{k+1} as a form of the components of (w, u) that are met, exactly."""
        here = self.steps[step]
        charged = here.cost if after is None else here.cost + self.brought(step + 1, after)
        total = kappa * here.price - self.taken(step, charged)
        d = len(own)
        total[:d, :d] += own
        return np.asarray(total[np.ix_(here.met, here.met)])


def turning_forms(vectors: int) -> list[NDArray[np.float64]]:
    """A basis of the symmetric matrices that commute with turns of some vectors about the third axis.

    Between any two vectors a and b these are a_z b_z, a_x b_x + a_y b_y and a_x b_y − a_y b_x.
    """
    result = []
    for i in range(vectors):
        for j in range(i, vectors):
            patterns = [[(2, 2, 1)], [(0, 0, 1), (1, 1, 1)], [(0, 1, 1), (1, 0, -1)]]
            for pattern in patterns[: 3 if i < j else 2]:
                form = np.zeros((3 * vectors, 3 * vectors))
                for row, column, sign in pattern:
                    form[3 * i + row, 3 * j + column] = form[3 * j + column, 3 * i + row] = sign
                result.append(form)
    return result
