"""Weights Λ in y = w − εΛh: a convex program over worst states, guided by counterexamples.

P of ``lyapcheck.check.loop`` is, but for its last part, linear in λ = ε₀Λ: with s = 1/(1+r),

    P(λ) = B + ½ s (S(λ) + S(λ)ᵀ) − ¼ s Σ_i (λ_i/k_i) x_i x_iᵀ,   x_i the rows of B + s S,

so with the x_i of the last turn it is a linear matrix inequality at each state. The program makes Σ ln λ_i as
large as it can under those of the states at hand; from where the result is nearest to failing, CasADi and
IPOPT climb, and what they find joins them, until nothing fails. What comes out is a proposal: branch and
bound, and then the checker, decide. Λ = I is where the program begins, and the answer where nothing with a
larger product of λ is accepted.

References: ``boyd1994lmi``, section 2.5 (cutting planes).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import prod

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array, Progress, part, silent
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.convex import solved
from lyapcheck.lyapunov import graph
from lyapcheck.search.certified import MAX_BOXES, certify
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof
from lyapcheck.search.schur import SchurProblem
from lyapcheck.search.worst_states import Program, States, fast, ranges_of_state, symbols_of

SAMPLES = 20_000
KEPT = 12
TURNS = 12
SOFTEST = 1e-12
"""N·m, of K_p Λ⁻¹ − ¼ L K_v: what is no larger resists at every state."""
MARGIN = 0.02
"""P(λ) ⪰ MARGIN·B is asked for: what lies between the sampled states needs some room."""
SHARES = tuple(Fraction(n, 100) for n in (60, 80, 90, 95, 100))
"""Shares of the proposed λ that are tried one after the other; boxes are few for small ones."""


@dataclass(frozen=True)
class Effort:
    """How long weights are sought: turns of the program and boxes of all attempts together."""

    turns: int = TURNS
    boxes: int = MAX_BOXES


@dataclass(frozen=True)
class Weighted:
    """The proof with the largest product of ε₀Λ that the checker accepted, that of Λ = I perhaps.

    Args:
        proof: its closure holds ε₀ and Λ, the smallest entry of Λ being 1.
        states: how many states the program saw.
        looked_at: boxes of all attempts.
        reason: why the product is not larger.
    """

    proof: DecreaseProof
    states: int
    looked_at: int
    reason: str = ""

    @property
    def products(self) -> tuple[Fraction, ...]:
        """ε₀Λ, joint by joint."""
        loop = self.proof.loop
        return tuple(loop.eps0 * scale for scale in loop.Lambda)


@dataclass(frozen=True)
class Seen:
    """States with what P needs there.

    Args:
        states: without rates.
        S: of each unit weight, (count, joint, n, n).
        s: 1/(1 + r), (count,).
    """

    states: States
    S: Array
    s: Array

    def joined(self, other: Seen) -> Seen:
        """Both lists of states."""
        states = States(*(np.vstack([getattr(x.states, name) for x in (self, other)]) for name in "qew"))
        return Seen(states, np.concatenate([self.S, other.S]), np.concatenate([self.s, other.s]))


def weighted_epsilon(
    controlled: ControlledArm,
    certified: DecreaseProof,
    effort: Effort = Effort(),
    jobs: int = 1,
    on_progress: Progress | None = None,
) -> Weighted:
    """The weights with a proof whose ε₀Λ has the largest product.

    Args:
        controlled: gains and arm, at its nominal numbers.
        certified: what is proved with Λ = I, where the search begins.
        effort: how long to search.
        jobs: processes for the checker.

    Soundness: ``lyapcheck.check.verify`` has accepted what is handed back, if it has accepted ``certified``.
    """
    progress = on_progress or silent
    proposal = _Proposal(controlled)
    weights, states = proposal.made(float(certified.loop.eps0), effort.turns, part(progress, 0, 0.5))
    found: list[DecreaseProof] = []
    looked_at, reason = 0, ""
    for index, share in enumerate(SHARES):
        progress(0.5 + 0.5 * index / len(SHARES), f"{float(share):.0%} of the proposed weights")
        loop = controlled.loop(*_rounded([Fraction(float(x)) * share for x in weights]))
        if prod(loop.eps0 * scale / certified.loop.eps0 for scale in loop.Lambda) <= 1:
            reason = "the convex program proposes none with a larger product"
            continue
        if not loop.admissible:
            reason = f"{float(share):.0%} of what the convex program proposes is too much for K_p"
            break
        outcome = certify(SchurProblem(loop), max(0, effort.boxes - looked_at))
        looked_at += outcome.boxes
        if not outcome.proved:
            reason = f"{float(share):.0%} of what the convex program proposes: {outcome.reason}"
            break
        reason = ""
        found.append(controlled.proof(loop, BoxTree(outcome.tree)))
    while found:
        accepted = found.pop().accepted(jobs)
        if accepted is not None:
            return Weighted(accepted, states, looked_at, reason)
        reason = "the boxes found were refused by the checker"
    return Weighted(certified, states, looked_at, reason)


def _rounded(weights: list[Fraction]) -> tuple[Fraction, tuple[Fraction, ...]]:
    """ε₀ and Λ from ε₀Λ, as short decimals from below; the smallest entry of Λ is 1."""
    eps0 = Fraction(int(min(weights) * 10**6), 10**6)
    return eps0, tuple(max(Fraction(1), Fraction(int(x / eps0 * 1000), 1000)) for x in weights)


def resisting_program(controlled: ControlledArm) -> Program:
    """Max over (q, e, v) of 1 − vᵀP(λ)v/vᵀBv; its parameters are λ."""
    n, at, B = controlled.n, symbols_of(controlled), ca.DM(controlled.viscous)
    weights, v = ca.SX.sym("weights", n), ca.vertcat(*at.w)
    F = graph.matrix(at.fast(ca.vertsplit(weights)))
    x = B * v - F.T @ v
    largest = float(controlled.family.constants().L.upper) / 4 * ca.DM(controlled.kv)
    compliance = 1 / ca.fmax(ca.DM(controlled.kp) / weights - largest, SOFTEST)
    top = ca.bilin(F, v, v) + at.near / 4 * ca.dot(compliance, x * x)
    return Program(
        ca.vertcat(*at.q, *at.e, v), top / ca.dot(v, B * v), ranges_of_state(n, 2.0), parameters=weights
    )


class _Proposal:
    """λ = ε₀Λ by turns of the convex program and of looking for states where its answer fails."""

    def __init__(self, controlled: ControlledArm) -> None:
        self.controlled, self.n = controlled, controlled.n
        self.B, self.root = np.diag(controlled.viscous), np.sqrt(controlled.viscous)
        random, shape = np.random.default_rng(SEED), (SAMPLES, self.n)
        e = random.choice([-1.0, 1.0], shape) * 10 ** random.uniform(-3, 0.7, shape)
        self.sampled = States(random.uniform(-np.pi, np.pi, shape), e, np.zeros(shape))
        self.resisting = resisting_program(controlled)

    def made(self, eps0: float, turns: int, progress: Progress) -> tuple[Array, int]:
        """λ, and how many states it was made for."""
        weights = np.full(self.n, eps0)
        active = self._worst(weights)
        for turn in range(turns):
            progress(turn / turns, f"convex program over {len(active.s)} states")
            weights = self._program(active, weights)
            seen = self._worst(weights)
            failing = self.smallest(seen, weights) < MARGIN / 2
            if not failing.any() and turn > 2:
                break
            chosen = np.flatnonzero(failing)
            active = active.joined(Seen(seen.states.take(chosen), seen.S[chosen], seen.s[chosen]))
        return weights, len(active.s)

    def _worst(self, weights: Array) -> Seen:
        """The worst of the samples, and where CasADi climbs from them."""
        values, vectors = self._spectrum(*self._at(self.sampled, weights), weights)
        chosen: NDArray[np.intp] = np.argsort(values[:, 0], kind="stable")[:KEPT]
        worst, directions = self.sampled.take(chosen), vectors[chosen, :, 0] / self.root
        starts = np.hstack([worst.q, worst.e, directions / np.linalg.norm(directions, axis=1)[:, None]])
        ends = self.resisting.climb(starts, weights)
        states = States(*np.split(np.vstack([starts, ends]), 3, axis=1))
        parts = [self._at(states, unit) for unit in np.eye(self.n)]
        s = parts[0][1]
        return Seen(states, np.stack([sS for sS, _ in parts], axis=1) / s[:, None, None, None], s)

    def _program(self, seen: Seen, near: Array) -> Array:
        """The weights that the convex program gives for some states, starting from ``near``."""
        import cvxpy as cp

        n, scale = self.n, np.outer(self.root, self.root)
        x = self.B + seen.s[:, None, None] * np.einsum("i,cijk->cjk", near, seen.S)
        weights = cp.Variable(n, pos=True)
        constraints = [weights <= 3 * near, weights >= near / 3]
        for S, s, rows in zip(seen.S, seen.s, x, strict=True):
            softer = np.einsum("ij,ik->ijk", rows, rows) / (4 * self.controlled.kp[:, None, None])
            linear = s * ((S + np.swapaxes(S, 1, 2)) / 2 - softer) / scale
            P = cp.reshape(linear.reshape(n, n * n).T @ weights, (n, n), order="C") + self.B / scale
            constraints.append(P - MARGIN * np.eye(n) >> 0)
        # almost solved is good enough for a proposal; without one the next turn begins a bit nearer to 0
        found = solved(cp.sum(cp.log(weights)), constraints, [weights]).values
        return found[0] if found else near * 0.9

    def smallest(self, seen: Seen, weights: Array) -> Array:
        """λmin(B^−½ P B^−½) at each state."""
        sS = seen.s[:, None, None] * np.einsum("i,cijk->cjk", weights, seen.S)
        return np.asarray(self._spectrum(sS, seen.s, weights)[0][:, 0])

    def _spectrum(self, sS: Array, s: Array, weights: Array) -> tuple[Array, Array]:
        """Eigenvalues and vectors of B^−½ P B^−½, from s S(λ) and s."""
        known = self.controlled
        X, L = self.B + sS, float(known.family.constants().L.upper)
        compliance = 1 / np.maximum(known.kp / weights - L * known.kv / 4, SOFTEST)
        slow = np.einsum("cki,k,ckj->cij", X, compliance, X)
        P = self.B + (sS + np.swapaxes(sS, 1, 2)) / 2 - s[:, None, None] / 4 * slow
        values, vectors = np.linalg.eigh(P / np.outer(self.root, self.root))
        return values, vectors

    def _at(self, states: States, scales: Array) -> tuple[Array, Array]:
        """s S at each state, (M Λh) êᵀ s² + s C(q, Λh) − s M Λh', and s."""
        at = self.controlled.lyapunov.at_columns(states.q, states.e, states.w)
        return -np.swapaxes(fast(at, scales), 1, 2), np.asarray(at.near)
