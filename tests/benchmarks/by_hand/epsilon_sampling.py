"""What a user would write for ε₀ of the three-joint arm: random states, and the smallest ε₀ that one refutes.

dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀² at a given state, so each state refutes every ε₀ above a root.

Usage: python epsilon_sampling.py GAINS.toml M STATES
"""

import sys
import tomllib
from pathlib import Path

import numpy as np
from arms import VISCOUS, buap3, coriolis, dh, h

BLOCK, SEED = 50_000, 1


def states(random, count):
    def directions():
        x = random.normal(size=(count, 3))
        return x / np.linalg.norm(x, axis=1, keepdims=True)

    q = random.uniform(-np.pi, np.pi, (count, 3))
    e = directions() * 10 ** random.uniform(-3, 1, (count, 1))
    return q, e, directions() * 10 ** random.uniform(-3, 2, (count, 1))


def dot(a, b):
    return np.sum(a * b, axis=-1)


def times(matrix, x):
    return np.einsum("...ij,...j->...i", matrix, x)


def refuted(m, kp, kv, q, e, w):
    M, dM = buap3(q)
    he, hw, r = h(m, e), h(m, w), np.linalg.norm(e, axis=-1)
    C, slope, near = coriolis(dM, w), dh(m, e) * w, dot(e, w) / (r * (1 + r))
    damping, s = VISCOUS["buap3"] * w + kv * hw, 1 / (1 + r)
    Mw, Mh, Ch = times(M, w), times(M, he), times(C, he)
    a0 = dot(w, damping)
    a1 = s * (dot(slope, Mw) - near * dot(he, Mw) - dot(w, Ch) + dot(he, damping) - dot(he, kp * he))
    a2 = s**2 * (dot(he, Ch) + near * dot(he, Mh) - dot(slope, Mh))
    with np.errstate(invalid="ignore"):
        root = 2 * a0 / (a1 + np.sqrt(a1**2 + 4 * a0 * a2))
    return np.min(root[root > 0], initial=np.inf)


if __name__ == "__main__":
    sets = tomllib.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["gains"]
    item = next(item for item in sets if item["m"] == int(sys.argv[2]))
    kp, kv, random = np.array(item["kp"]), np.array(item["kv"]), np.random.default_rng(SEED)
    blocks = int(sys.argv[3]) // BLOCK
    print(min(refuted(item["m"], kp, kv, *states(random, BLOCK)) for _ in range(blocks)))
