"""Gains on a computer, from starts at rest, by an energy that falls; and what shows none.

    python -m tests.arena.from_rest

adds them to the arena as it stands.
"""

from __future__ import annotations

import json
from dataclasses import fields, replace
from fractions import Fraction as F

from lyapcheck.check.kinds.sampled_from_rest import SampledFromRest
from lyapcheck.check.verify import verify
from lyapcheck.search.sampled_energy import falling_energy
from tests.arena.attacks import edited, encoded
from tests.arena.extra import MIXED
from tests.arena.library import Added
from tests.arena.plant import ARENA
from tests.arena.truths import certified

ONE = SampledFromRest(
    *("tanh", None, (F(4),), (F(3),), ((F(1), F(2)),), (((((0, 0, 1), F(1)),),),)),
    *((((0, 1, 0), F(-1)),), ((F(1), F(2)),), F(1, 100), 1, F(60)),
)
"""U = −cos q; k_v = 3 is above the friction, so that light arms would not be stable."""
RODS = (
    (((((0, 0, 0, 0), F(4)), ((0, 0, 0, 1), F(2)))), MIXED),
    (MIXED, (((0, 0, 0, 0), F(2)),)),
)
TWO = SampledFromRest(
    *("hyperbolic", 1, (F(20), F(8)), (F(12), F(5)), ((F(1), F(1)), (F(1), F(1))), RODS),
    *((((0, 0, 1, 0), F(-2)),), (), F(1, 500), 0, F(45)),
)
"""Links with mass at their ends and rotors, upright in no direction: g_1 = 2 sin q_1."""


def main() -> None:
    """Write the files, and what is expected of them."""
    arena = Added("frm")
    for name, statement in (("one", ONE), ("two", TWO)):
        proof = falling_energy(statement)
        assert proof is not None
        V = proof.energy
        accepted = verify(statement, proof)
        content = certified(name, statement, proof, accepted.verdict, accepted.grade)
        arena.add(f"good/{name}.frm.json", content, ["accepted"], "")
        heavy = tuple(tuple(tuple((p, c / 100) for p, c in x) for x in row) for row in statement.mass)
        for fault, asked in {
            "late-and-slow": replace(statement, period=F(3)),
            "light": replace(statement, mass=heavy),
            "damped-too-much": replace(statement, kv=tuple(1000 * k for k in statement.kv)),
            "stiff": replace(statement, kp=tuple(10_000 * k for k in statement.kp)),
            "from-afar": replace(statement, within=F(3000)),
            "flat": replace(statement, family="hyperbolic", m=2),
            "another-h": replace(statement, family="arctan", m=None),
            "steep": replace(statement, potential=tuple((p, 1000 * c) for p, c in statement.potential)),
        }.items():
            content = certified(fault, asked, proof, "proved", "enclosure")
            arena.add(f"bad/{name}-{fault}.frm.json", content, ["refused"], f"another loop: {fault}")
        none = replace(
            V.splits,
            **{one.name: ((F(0),) * len(statement.kp),) * len(statement.kp) for one in fields(V.splits)},
        )
        for fault, by in {
            "no-splits": replace(proof, energy=replace(V, splits=none)),
            "coupled": replace(proof, energy=replace(V, coupling=tuple(100 * x for x in V.coupling))),
            "uncoupled": replace(proof, energy=replace(V, coupling=tuple(0 * x for x in V.coupling))),
            "no-weight": replace(proof, energy=replace(V, weight=F(0))),
            "minus": replace(proof, energy=replace(V, mean=tuple(-1 - x for x in V.mean))),
            "kept": replace(proof, energy=replace(V, kept=((F(99),) * len(V.kept[0]),) * len(V.kept))),
            "short": replace(proof, energy=replace(V, reach=F(9, 10))),
            "cut": replace(proof, energy=replace(V, moved=V.moved[1:])),
            "two-slow": replace(proof, energy=replace(V, slow=tuple(2 + x for x in V.slow))),
            "heavier": replace(proof, least=tuple(100 * x for x in proof.least)),
            "slower": replace(proof, speed=proof.speed / 2),
            "all-of-it": replace(proof, share=F(1)),
        }.items():  # fmt: skip
            content = certified(fault, statement, by, "proved", "enclosure")
            arena.add(f"bad/{name}-{fault}.frm.json", content, ["refused"], f"no energy that falls: {fault}")
    proof = falling_energy(TWO)
    assert proof is not None
    whole = json.loads(certified("two", TWO, proof, "proved", "enclosure"))
    skewed = [*whole["statement"]["mass"][0][1], [[0, 0, 0, 0], "1"]]
    for fault, field, value in (
        ("no-arm", ("mass",), []),
        ("few", ("kp",), ["1"]),
        ("no-gain", ("kv",), ["0", "1"]),
        ("turned-range", ("viscous",), [["2", "1"], ["1", "1"]]),
        ("no-time", ("period",), "0"),
        ("late", ("delay",), 7),
        ("nowhere", ("within",), "0"),
        ("skewed", ("mass", 0, 1), skewed),
    ):
        content = encoded(edited(whole, [(("statement", *field), value)]))
        arena.add(f"bad/form-{fault}.frm.json", content, ["refused"], f"no such loop: {fault}")
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
