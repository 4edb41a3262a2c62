"""What a certificate costs: boxes and seconds against the share of the falsified ε₀, and against n."""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TypeVar

from lyapcheck import GainSet, load_robot, paper_gain_file, read_gain_file
from lyapcheck.check.loop.processes import shared_between
from lyapcheck.check.loop.proof import proves
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.falsify import falsify
from lyapcheck.search.schur import SchurProblem

from .measure import LYAPCHECK, processor_seconds
from .results import CertificateResult, Cost, ManyResult

T = TypeVar("T")

ARMS = ("pendulum1", "reyes-kelly2", "buap3")
MANY = (("px100", (1,)), ("px150", (1,)), *((arm, (1, 2, 3)) for arm in ("ur5", "xarm6", "iiwa14", "panda")))
EXAMPLES = Path(__file__).parents[2] / "examples"
MEMBERS = (1, 2, 3, 4, 5)
SHARES = tuple(Fraction(n, 1000) for n in (900, 950, 980, 990, 995))
MAX_BOXES = 600_000
LAST_PRINTED = 3
"""Table 2 ends with m = 3: beyond it, its gains are taken."""


def benchmark(
    arms: tuple[str, ...] = ARMS,
    members: tuple[int, ...] = MEMBERS,
    shares: tuple[Fraction, ...] = SHARES,
    max_boxes: int = MAX_BOXES,
) -> Iterator[CertificateResult]:
    """Each share is proved from nothing: search alone, then the checker on both processors."""
    for arm in arms:
        model = load_robot(arm)
        for m in members:
            controlled = ControlledArm(gains(arm, m), model)
            witness = falsify(controlled)
            if witness is None:
                raise RuntimeError(f"no state refutes any ε₀ on {arm}, m = {m}")
            costs = tuple(_cost(controlled, witness.eps0, share, max_boxes) for share in shares)
            yield CertificateResult(arm, model.n, m, float(witness.eps0), costs)


def many_joints(arms: Sequence[tuple[str, tuple[int, ...]]] = MANY) -> Iterator[ManyResult]:
    """The whole command ``epsilon`` on arms of four joints and more, and ``recheck`` of its certificate."""
    for arm, members in arms:
        for m in members:
            yield _many(arm, m)


def _many(arm: str, m: int) -> ManyResult:
    with tempfile.TemporaryDirectory() as folder:
        line = [LYAPCHECK, "epsilon", str(EXAMPLES / f"{arm}_gains.toml"), "--m", str(m)]
        line += ["--no-store", "--format", "json", "--certificates", folder]
        output, seconds = processor_seconds(line)
        (row,) = json.loads(output)["results"]
        (proof,) = Path(folder).glob("*.certified.json")
        _, checked = processor_seconds([LYAPCHECK, "recheck", str(proof)])
        certified, falsified = float(row["certified"]), float(row["falsified"])
        joints = load_robot(arm).n
        return ManyResult(arm, joints, m, certified, falsified, seconds, proof.stat().st_size, checked)


def gains(arm: str, m: int) -> GainSet:
    """Table 2: all of it, shoulder and elbow, or the shoulder alone."""
    sets = read_gain_file(paper_gain_file("table2" if arm == "buap3" else "table2_shoulder_elbow")).gains
    like = next(item for item in sets if item.m == min(m, LAST_PRINTED))
    n = {"pendulum1": 1}.get(arm, like.n)
    return replace(like, name=f"m{m}", m=m, kp=like.kp[:n], kv=like.kv[:n])


def _cost(controlled: ControlledArm, falsified: Fraction, share: Fraction, max_boxes: int) -> Cost:
    loop = controlled.loop((falsified * share).limit_denominator(10**9))
    outcome, searched = _timed(lambda: certify(SchurProblem(loop), max_boxes))
    if not outcome.proved:
        return Cost(float(share), outcome.boxes, searched, None)
    with shared_between(2):
        accepted, checked = _timed(lambda: proves(loop, outcome.tree))
    if not accepted:
        raise RuntimeError(f"the checker refused {outcome.boxes} boxes for ε₀ = {float(loop.eps0):.6g}")
    return Cost(float(share), outcome.boxes, searched, checked)


def _timed(call: Callable[[], T]) -> tuple[T, float]:
    begin = time.perf_counter()
    result = call()
    return result, time.perf_counter() - begin
