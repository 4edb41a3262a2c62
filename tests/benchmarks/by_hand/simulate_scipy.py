"""What a user would write for the closed loop of the three-joint arm: solve_ivp on NumPy matrices.

Usage: python simulate_scipy.py GAINS.toml
"""

import sys
import tomllib
from pathlib import Path

import numpy as np
from arms import VISCOUS, buap3, coriolis, h
from scipy.integrate import solve_ivp

GOAL, SECONDS = np.radians([45, 45, 90]), 5.0


def closed_loop(m, kp, kv):
    def rate(t, y):
        q, w = y[:3], y[3:6]
        e = GOAL - q
        M, dM = buap3(q)
        torque = kp * h(m, e) - kv * h(m, w) - VISCOUS["buap3"] * w - coriolis(dM, w) @ w
        return np.concatenate([w, np.linalg.solve(M, torque), [e @ e]])

    return rate


if __name__ == "__main__":
    for item in tomllib.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["gains"]:
        rate = closed_loop(item["m"], np.array(item["kp"]), np.array(item["kv"]))
        path = solve_ivp(rate, (0, SECONDS), np.zeros(7), method="LSODA", rtol=1e-9, atol=1e-12)
        print(item["name"], np.degrees(np.sqrt(path.y[6, -1] / SECONDS)))
