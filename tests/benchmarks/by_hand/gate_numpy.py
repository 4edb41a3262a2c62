"""What a user would write for the gate: γ_m as the largest value on a grid, (10p) and (19) in floating point.

Usage: python gate_numpy.py GAINS.toml
"""

import sys
import tomllib
from functools import cache
from pathlib import Path

import numpy as np

TORQUE, GRAVITY, VISCOUS_MIN = np.array([50, 150, 15]), np.array([0, 40.28, 1.81]), 0.406


@cache
def gamma(m):
    x = np.linspace(1e-3, 20, 200_001)
    s = np.sinh(x)
    return np.max(s ** (2 * m - 1) * np.cosh(x) / (1 + s ** (2 * m)))


if __name__ == "__main__":
    for item in tomllib.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["gains"]:
        kp, kv, scale = np.array(item["kp"]), np.array(item["kv"]), np.sqrt(3) * gamma(item["m"])
        fits = np.all(kp + kv < (TORQUE - GRAVITY) / scale) and np.all(kv < VISCOUS_MIN / scale)
        print(item["name"], "accepted" if fits else "rejected")
