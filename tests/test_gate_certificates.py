"""Certificates as conditions, and what the gate says where they and (19) disagree."""

from __future__ import annotations

import json
import sys
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from lyapcheck import load_robot, named_family
from lyapcheck.check.loop import proves
from lyapcheck.cli import main as cli
from lyapcheck.control import paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.gating import GateResult, gate, gate_exit
from lyapcheck.gating.formats import FORMATS, renderer
from lyapcheck.gating.stability import Stability, remarks, stability
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.setting import Setting
from lyapcheck.verdicts import Exit

TABLE2 = paper_gain_file("table2_shoulder_elbow")


def judged(path: Path = TABLE2, *deciding: str, strict: bool = False) -> dict[str, GateResult]:
    found = gate(read_gain_file(path), None, deciding or ("10p", "19"), strict=strict)
    return {result.name: result for result in found}


def gain_file(path: Path, top: str, kv: str = "[0.1, 0.1]", end: str = "") -> Path:
    path.write_text(f"{top}\n[[gains]]\nname = 'a'\nm = 2\nkp = [1, 1]\nkv = {kv}\n{end}")
    return path


@pytest.fixture(scope="module")
def scalar() -> dict[str, GateResult]:
    return judged(TABLE2, "scalar")


@pytest.fixture(scope="module")
def everywhere() -> dict[str, GateResult]:
    return judged(TABLE2, "global", "19")


# --- the scalar certificate --------------------------------------------------------------------


def test_the_scalar_form_is_definite_at_the_value_shown(scalar: dict[str, GateResult]) -> None:
    """Θ' by its definition, with norms of M and C over a grid of the one angle they depend on."""
    arm, angles = NumericModel(load_robot("reyes-kelly2")), np.linspace(-np.pi, np.pi, 2001)
    q = np.stack([np.zeros_like(angles), angles], axis=1)
    beta = np.linalg.norm(arm.mass(q), 2, axis=(1, 2)).max()
    turns = np.linspace(0, np.pi, 181)
    units = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    k_c = max(np.linalg.norm(arm.coriolis(q, np.tile(x, (len(q), 1))), 2, axis=(1, 2)).max() for x in units)
    b = np.array([2.288, 0.175])
    for result in scalar.values():
        (check,) = [check for check in result.checks if check.id == "scalar"]
        assert (check.verdict, result.verdict) == ("accepted", "accepted")
        assert check.value is not None
        known, kp, kv = named_family("hyperbolic", result.m).constants(), result.gains.kp, result.gains.kv
        assert known.gamma is not None
        reach, rho, L = 2**0.5 * float(known.gamma.mid), float(known.rho.mid), float(known.L.mid)
        G = reach * L / (reach + L)
        eps = float(check.value)
        c, d = beta * (rho + G) + reach * k_c, b.max() + L * float(max(kv))
        theta = np.array(
            [
                [eps * float(min(kp)), -eps / 2 * (d + eps * c)],
                [-eps / 2 * (d + eps * c), b.min() - eps * c],
            ]
        )
        assert np.linalg.eigvalsh(theta)[0] > 0
        theta[0, 1] = theta[1, 0] = -1.02 * eps / 2 * (d + 1.02 * eps * c)
        theta[1, 1], theta[0, 0] = b.min() - 1.02 * eps * c, 1.02 * eps * float(min(kp))
        assert np.linalg.eigvalsh(theta)[0] < 0


def test_less_friction_than_the_arms_makes_less_of_it(tmp_path: Path) -> None:
    def eps0(end: str) -> Fraction:
        (result,) = judged(
            gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'", end=end), "scalar"
        ).values()
        assert result.checks[-1].value is not None
        return result.checks[-1].value

    plain = eps0("")
    assert eps0("[bounds]\nviscous_min = 0.175\n") == plain
    assert 0 < eps0("[bounds]\nviscous_min = 0.05\n") < plain / 2


# --- the global certificate --------------------------------------------------------------------


def test_the_global_value_is_proved_and_below_what_a_state_refutes(everywhere: dict[str, GateResult]) -> None:
    """The smallest ε₀ that a state refutes on this arm: 0.8106, 0.9264 and 0.6362."""
    for result, refuted in zip(everywhere.values(), ("0.8106", "0.9264", "0.6362"), strict=True):
        value = result.checks[-1].value
        assert value is not None
        assert Fraction(1, 10) < value < Fraction(refuted)


def test_what_the_checker_refuses_is_not_accepted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Without the checker's word there is no certificate, whatever the search says; and no rejection."""
    import lyapcheck.gating.certificates as room
    from lyapcheck.search.proof import Proof

    monkeypatch.setattr(Proof, "accepted", lambda *_, **__: False)
    monkeypatch.setattr(room, "radial_epsilon", lambda _: None)
    monkeypatch.setattr(room, "CEILINGS", (64, 4))
    (result,) = judged(gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'"), "global").values()
    assert result.verdict == "undecided"
    assert "accepted no proof" in result.failures[0].reason


def test_the_last_way_is_the_checkers_own_scalar_form() -> None:
    """A tree of one leaf, which only that form can prove."""
    setting = Setting(read_gain_file(TABLE2).gains[0], load_robot("reyes-kelly2"))
    assert proves(setting.closure(Fraction(1, 1000)), ".")
    assert not proves(setting.closure(Fraction(1)), ".")


# --- undecided, never rejected -----------------------------------------------------------------

BOUNDS = "[bounds]\nviscous_min = 0.4\ntorque = [9, 9]\ngravity = [1, 1]\n"


@pytest.mark.parametrize("name", ["scalar", "global"])
def test_without_an_arm_a_certificate_is_undecided(tmp_path: Path, name: str) -> None:
    (result,) = judged(gain_file(tmp_path / "g.toml", "", end=BOUNDS), name).values()
    assert (result.verdict, result.checks[-1].value) == ("undecided", None)
    assert "name one" in result.failures[0].reason
    assert remarks(result) == [f"(10p) and (19) hold, yet no {name} certificate was found"]


def test_another_friction_leaves_the_global_one_undecided(tmp_path: Path) -> None:
    path = gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'", end="[bounds]\nviscous_min = 0.1\n")
    (result,) = judged(path, "global").values()
    assert result.verdict == "undecided"
    assert "viscous_min" in result.failures[0].reason


def test_an_unbounded_function_has_a_scalar_certificate_and_no_global_one() -> None:
    (result,) = judged(paper_gain_file("table2_pd"), "scalar", "global").values()
    assert [check.verdict for check in result.checks[-2:]] == ["accepted", "undecided"]
    assert result.verdict == "undecided"
    assert remarks(result)[-1].startswith("(10p) fails: a motor may saturate")


def test_an_unknown_condition_is_refused() -> None:
    with pytest.raises(InputError, match="scalar, global"):
        judged(TABLE2, "10p", "lmi")


# --- what is said where conditions disagree ----------------------------------------------------


def test_gains_that_fail_19_are_told_to_be_stable() -> None:
    """By default from the theorem, which needs no search; with a certificate, with its ε₀."""
    result = judged(paper_gain_file())["tau_m2"]
    assert result.verdict == "rejected"
    assert stability(result) == Stability("theorem")
    (said,) = remarks(result)
    assert said.startswith("(19) fails, yet it is not needed")
    assert "arms.all" in said
    assert said.endswith("--condition scalar proves an ε₀")


def test_with_a_certificate_both_facts_are_told(everywhere: dict[str, GateResult]) -> None:
    for result in everywhere.values():
        assert result.verdict_of(("19",)) == "rejected" == result.verdict
        (said,) = remarks(result)
        assert said.startswith("(19) fails, yet the gains are proved stable without it: global certificate")
        known = stability(result)
        assert known is not None
        assert (known.by, known.eps0) == ("global", result.checks[-1].value)


def test_where_all_agree_nothing_is_said() -> None:
    assert remarks(judged(paper_gain_file())["tau_m1"]) == []


def test_without_an_arm_the_theorem_says_what_it_assumes(tmp_path: Path) -> None:
    path = gain_file(tmp_path / "g.toml", "", "[9, 9]", BOUNDS)
    (result,) = judged(path).values()
    known = stability(result)
    assert known is not None
    assert known.assumes == ("the arm has Properties 2.1 to 2.7",)
    assert "given that the arm has Properties 2.1 to 2.7" in remarks(result)[0]
    assert remarks(result)[1].startswith("(10p) fails")


def test_the_theorem_is_not_stretched_to_other_functions(tmp_path: Path) -> None:
    """It was proved for the hyperbolic family; of another function the gate says how to find out."""
    path = gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'", "[9, 9]")
    path.write_text(path.read_text().replace("m = 2", "family = 'tanh'"))
    (result,) = judged(path).values()
    assert stability(result) is None
    assert "--condition scalar looks for a proof" in remarks(result)[0]
    (proved,) = judged(path, "scalar").values()
    assert "proved stable without it" in remarks(proved)[0]


def test_without_friction_nothing_is_promised(tmp_path: Path) -> None:
    """(19) fails for every gain, and no proof here does without friction: then no hope is raised."""
    path = gain_file(tmp_path / "g.toml", "", "[" + ", ".join(["0.1"] * 6) + "]")
    path.write_text(path.read_text().replace("[1, 1]", "[" + ", ".join(["1"] * 6) + "]"))
    ur5 = str(Path(__file__).parent / "arms" / "ur5.urdf")
    for deciding in (("10p", "19"), ("19", "scalar", "global")):
        (result,) = gate(read_gain_file(path), ur5, deciding)
        assert result.verdict_of(("19",)) == "rejected"
        assert (stability(result), remarks(result)) == (None, [])
    assert [check.verdict for check in result.checks[-2:]] == ["undecided", "undecided"]
    assert all("no viscous friction" in check.reason for check in result.checks[-2:])


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_tells_the_value_or_the_reason(name: str, everywhere: dict[str, GateResult]) -> None:
    results = list(everywhere.values())
    text = renderer(name)(results)
    if name in ("text", "markdown", "json"):
        assert str(float(results[0].checks[-1].value or 0)) in text
        assert "nominal" in text or name == "markdown"
    if name != "sarif":
        assert "yet the gains are proved stable without it" in text


def test_json_tells_what_establishes_stability(everywhere: dict[str, GateResult]) -> None:
    rows = json.loads(renderer("json")([*everywhere.values(), *judged(paper_gain_file()).values()]))[
        "results"
    ]
    assert [row["stable"]["by"] for row in rows] == ["global"] * 3 + ["theorem"] * 3
    for row in rows[:3]:
        assert Fraction(row["stable"]["eps0"]) == Fraction(row["checks"][-1]["value"]) > 0
        assert row["checks"][-1]["limit"] is None
        assert row["checks"][-1]["line"] is not None


# --- strict ------------------------------------------------------------------------------------


def test_strict_makes_undecided_a_failure(tmp_path: Path) -> None:
    path = gain_file(tmp_path / "g.toml", "robot = 'pelican2'", "[0.01, 0.01]")
    (loose,), (strict,) = judged(path).values(), judged(path, strict=True).values()
    assert (loose.verdict, strict.verdict) == ("undecided", "undecided")
    assert (gate_exit([loose]), gate_exit([strict])) == (Exit.UNDECIDED, Exit.REFUTED)
    counts = []
    for result in (loose, strict):
        (suite,) = ET.fromstring(renderer("junit")([result]))
        counts.append((suite.get("tests"), suite.get("failures"), suite.get("skipped")))
        assert len(suite.findall("testcase/failure")) == int(suite.get("failures") or 0)
        assert len(suite.findall("testcase/skipped")) == int(suite.get("skipped") or 0)
    assert counts == [("4", "0", "2"), ("4", "2", "0")]
    assert (
        renderer("github")([loose]).count("::warning ") == renderer("github")([strict]).count("::error ") == 2
    )
    assert [json.loads(renderer("json")([result]))["results"][0]["strict"] for result in (loose, strict)] == [
        False,
        True,
    ]


@pytest.mark.parametrize(
    ("words", "code"), [((), 3), (("--strict",), 1), (("--strict", "--condition=19"), 0)]
)
def test_the_command_takes_strict(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, words: tuple[str, ...], code: int
) -> None:
    path = gain_file(tmp_path / "g.toml", "robot = 'pelican2'", "[0.01, 0.01]")
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "gate", str(path), *words])
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert left.value.code == code
