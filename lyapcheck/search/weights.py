"""Weights Λ in y = w − εΛh: a convex program over worst states, guided by counterexamples.

P of ``lyapcheck.check.loop`` is, but for its last part, linear in λ = ε₀Λ: with s = 1/(1+r),

    P(λ) = B + ½ s (S(λ) + S(λ)ᵀ) − ¼ s Σ_i (λ_i/k_i) x_i x_iᵀ,   x_i the rows of B + s S,

so with the x_i of the last turn it is a linear matrix inequality at each state. The program makes Σ ln λ_i as
large as it can under those of the states at hand; states where the result fails join them, until none is
found. What comes out is a proposal: branch and bound, and then the checker, decide.

References: ``boyd1994lmi``, section 2.5 (cutting planes).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress, part, silent
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.convex import solved
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.certified import MAX_BOXES
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.proof import DecreaseProof
from lyapcheck.search.sample import fast
from lyapcheck.search.schur import SchurProblem

SAMPLES = 20_000
KEPT = 12
TURNS = 12
CLIMBS = 40
MARGIN = 0.02
"""P(λ) ⪰ MARGIN·B is asked for: what lies between the sampled states needs some room."""
SHARES = tuple(Fraction(n, 100) for n in (100, 98, 95, 90, 80, 60, 40))
"""Shares of the proposed λ that are tried one after the other, from the largest."""


@dataclass(frozen=True)
class Weighted:
    """A proof with weights, and what Λ = I would have to give up for it.

    Args:
        proof: accepted by the checker; its closure holds ε₀ and Λ, the smallest entry of Λ being 1.
        states: how many states the program saw.
        looked_at: boxes of all attempts.
    """

    proof: DecreaseProof
    states: int
    looked_at: int

    @property
    def products(self) -> tuple[Fraction, ...]:
        """ε₀Λ, joint by joint."""
        loop = self.proof.loop
        return tuple(loop.eps0 * scale for scale in loop.Lambda)


@dataclass(frozen=True)
class WeightedStates:
    """States (q, e) with what P needs there: S of each unit weight (count, joint, n, n), and s (count,)."""

    S: Array
    s: Array

    def at(self, chosen: NDArray[np.intp]) -> WeightedStates:
        """Some of the states."""
        return WeightedStates(self.S[chosen], self.s[chosen])

    def joined(self, other: WeightedStates) -> WeightedStates:
        """Both lists of states."""
        return WeightedStates(np.concatenate([self.S, other.S]), np.concatenate([self.s, other.s]))


def weighted_epsilon(
    controlled: ControlledArm,
    eps0: Fraction,
    max_boxes: int = MAX_BOXES,
    jobs: int = 1,
    seed: int = 20190301,
    on_progress: Progress | None = None,
) -> Weighted | None:
    """Weights whose ε₀Λ is as large as possible in the sense of Σ ln(ε₀λ_i), with a proof; ``None`` if none.

    Args:
        controlled: gains and arm, at its nominal numbers.
        eps0: an ε₀ certified with Λ = I, where the search begins.
        max_boxes: budget of all attempts together.
        jobs: processes for the checker.
        seed: of the sampled states.
        on_progress: receives the share done.

    Soundness: ``lyapcheck.check.verify`` has accepted what is handed back.
    """
    progress = on_progress or silent
    result, states = _proposal(controlled, float(eps0), seed, part(progress, 0, 0.5))
    looked_at = 0
    for index, share in enumerate(SHARES):
        progress(0.5 + 0.5 * index / len(SHARES), f"{float(share):.0%} of the proposed weights")
        loop = controlled.loop(*_rounded([Fraction(float(x)) * share for x in result]))
        if not loop.admissible:
            continue
        outcome = certify(SchurProblem(loop), max(0, max_boxes // len(SHARES)))
        looked_at += outcome.boxes
        proof = (
            DecreaseProof(loop, BoxTree(outcome.tree), controlled.inertia_proof) if outcome.proved else None
        )
        accepted = None if proof is None else proof.accepted(jobs)
        if accepted is not None:
            return Weighted(accepted, states, looked_at)
    return None


def _rounded(products: list[Fraction]) -> tuple[Fraction, tuple[Fraction, ...]]:
    """ε₀ and Λ from ε₀Λ, as short decimals from below; the smallest entry of Λ is 1."""
    eps0 = Fraction(int(min(products) * 10**6), 10**6)
    return eps0, tuple(max(Fraction(1), Fraction(int(x / eps0 * 1000), 1000)) for x in products)


def _proposal(controlled: ControlledArm, eps0: float, seed: int, progress: Progress) -> tuple[Array, int]:
    """λ = ε₀Λ, and how many states it was made for."""
    random = np.random.default_rng(seed)
    q, e = _sample(controlled, random)
    states = _evaluated(controlled, q, e)
    result = np.full(controlled.n, eps0)
    active = states.at(_worst(controlled, states, result))
    for turn in range(TURNS):
        progress(turn / TURNS, f"convex program over {len(active.s)} states")
        result = _program(controlled, active, result)
        chosen = _worst(controlled, states, result)
        climbed = _climbed(controlled, q[chosen], e[chosen], result, random)
        seen = states.at(chosen).joined(climbed)
        failing = _smallest(controlled, seen, result) < MARGIN / 2
        if not failing.any() and turn > 2:
            break
        active = active.joined(seen.at(np.flatnonzero(failing)))
    return result, len(active.s)


def _program(controlled: ControlledArm, states: WeightedStates, near: Array) -> Array:
    """The weights that the convex program gives for some states, starting from ``near``."""
    import cvxpy as cp

    B, k = np.diag(controlled.viscous), controlled.kp
    x = B + states.s[:, None, None] * np.einsum("i,cijk->cjk", near, states.S)
    weights = cp.Variable(controlled.n, pos=True)
    constraints: list[Any] = [weights <= 3 * near, weights >= near / 3]
    root = np.sqrt(controlled.viscous)
    for S, s, rows in zip(states.S, states.s, x, strict=True):
        P = B
        for i in range(controlled.n):
            linear = s * (S[i] + S[i].T) / 2 - s / (4 * k[i]) * np.outer(rows[i], rows[i])
            P = P + weights[i] * linear
        constraints.append((P / np.outer(root, root)) - MARGIN * np.eye(controlled.n) >> 0)
    # almost solved is good enough for a proposal; without one the next turn begins a bit nearer to 0
    found = solved(cp.sum(cp.log(weights)), constraints, [weights]).values
    return found[0] if found else near * 0.9


def _smallest(controlled: ControlledArm, states: WeightedStates, weights: Array) -> Array:
    """λmin(B^−½ P B^−½) at each state."""
    B, root = np.diag(controlled.viscous), np.sqrt(controlled.viscous)
    S = np.einsum("i,cijk->cjk", weights, states.S)
    s = states.s[:, None, None]
    X = B + s * S
    L = float(controlled.family.constants().L.upper)
    compliance = 1 / np.maximum(controlled.kp / weights - L * controlled.kv / 4, 1e-12)
    P = B + s * (S + np.swapaxes(S, 1, 2)) / 2 - s / 4 * np.einsum("cki,k,ckj->cij", X, compliance, X)
    return np.asarray(np.linalg.eigvalsh(P / np.outer(root, root))[:, 0])


def _worst(controlled: ControlledArm, states: WeightedStates, weights: Array) -> NDArray[np.intp]:
    return np.asarray(np.argsort(_smallest(controlled, states, weights), kind="stable")[:KEPT])


def _climbed(
    controlled: ControlledArm, q: Array, e: Array, weights: Array, random: np.random.Generator
) -> WeightedStates:
    """The states after random steps towards smaller eigenvalues; the steps shrink."""
    value = _smallest(controlled, _evaluated(controlled, q, e), weights)
    for step in range(CLIMBS):
        size = 0.3 * 0.85**step
        moved = q + size * random.normal(size=q.shape), e * np.exp(size * random.normal(size=e.shape))
        moved = moved[0], moved[1] + 0.1 * size * random.normal(size=e.shape)
        result = _smallest(controlled, _evaluated(controlled, *moved), weights)
        better = result < value
        q, e = np.where(better[:, None], moved[0], q), np.where(better[:, None], moved[1], e)
        value = np.where(better, result, value)
    return _evaluated(controlled, q, e)


def _sample(controlled: ControlledArm, random: np.random.Generator) -> tuple[Array, Array]:
    """Random states, errors of all sizes in each joint."""
    shape = (SAMPLES, controlled.n)
    e = random.choice([-1.0, 1.0], shape) * 10 ** random.uniform(-3, 0.7, shape)
    return random.uniform(-np.pi, np.pi, shape), e


def _evaluated(controlled: ControlledArm, q: Array, e: Array) -> WeightedStates:
    """S of each unit weight: (M e_i h_i) êᵀ s + C(q, e_i h_i) − M e_i h_i' e_iᵀ, −Fᵀ/s of h_i alone."""
    at = controlled.lyapunov.at_columns(q, e, np.zeros_like(e))
    parts = [np.swapaxes(fast(at, joint), 1, 2) for joint in range(controlled.n)]
    return WeightedStates(-np.stack(parts, axis=1) / at.near[:, None, None, None], at.near)
