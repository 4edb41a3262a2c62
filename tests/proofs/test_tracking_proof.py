"""The tracking proof: the loop and its rate against numbers, the role of v_d, and faults."""

import pytest

from lyapcheck.claims import run_proof
from lyapcheck.errors import InputError
from lyapcheck.verdicts import Verdict
from tests.helpers.script_cases import rewriter, verdicts
from tests.helpers.shares import one_in
from tests.helpers.small_proofs import small_proof

pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.fixture(scope="module", params=["small", pytest.param("paper", marks=pytest.mark.slow)])
def result(request, tmp_path_factory):
    """For two joints and m = 1, or for the paper's arm and m = 1, 2, 3."""
    if request.param == "small":
        return small_proof(tmp_path_factory, "tracking.py")
    return run_proof("tracking.py", ms=(1, 2, 3))


@pytest.fixture
def altered(tmp_path):
    """The script with something replaced."""
    return rewriter("tracking.py", tmp_path)


def test_every_step_is_proved_for_the_gains_of_the_paper(result):
    assert {row.verdict for row in result.claims} == {Verdict.PROVED}
    concluded = {(row.id, row.m) for row in result.claims if "uniformly asymptotically" in row.statement}
    assert concluded == {(name, m) for name in ("21", "arm.21") for m in result.ms}


def test_the_conclusion_needs_bounds_without_time_on_both_sides(result):
    uses = {row.id: set(row.uses) for row in result.claims}
    assert {"21.below", "21.above", "21.form", "21.loop", "21.small"} <= uses["21"]
    assert "rate.5" not in uses["21.form"], "terms 5 and 9 are those with the desired velocity in them"
    assert "rate.9" not in uses["21.form"]


# The role of v_d and ε₀ -------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("speed", one_in(3, ["Fraction(1000)", "Fraction(0)", "Fraction(1, 10)"]))
def test_every_speed_has_its_eps0(altered, speed):
    path = altered("SPEED = Fraction(2)", f"SPEED = {speed}")
    assert verdicts(path, ("arm.21",)) == {"arm.21": "proved"}


@pytest.mark.slow
def test_an_eps0_for_a_lower_speed_is_not_enough(altered):
    path = altered(
        "gains.kv))\n    return min(gains.kp), arm.b_min, c, d, arm.kc * SPEED",
        "gains.kv))\n    return min(gains.kp), arm.b_min, c, d, arm.kc * SPEED",
    )
    source = path.read_text(encoding="utf-8")
    path.write_text(
        source.replace(
            "    k, b, c, d, turn = form_numbers(m, n, robot, gains)\n\n    def",
            "    k, b, c, d, turn = form_numbers(m, n, robot, gains)\n    turn = turn / 2\n\n    def",
        ),
        encoding="utf-8",
    )
    assert verdicts(path, ("arm.21.theta", "arm.21")) == {"arm.21.theta": "refuted", "arm.21": "undecided"}


@pytest.mark.slow
def test_an_eps0_that_is_too_large_is_refuted(altered):
    path = altered("SHARE = Fraction(99, 100)", "SHARE = Fraction(101, 100)")
    assert verdicts(path, ("arm.21.theta", "21")) == {"arm.21.theta": "refuted", "21": "proved"}


FUNCTION = "FAMILY.tracking(FAMILY.h_of(m), eps0)"


def tracking(value, potential):
    """With another h and U."""
    return f"FAMILY.tracking(FAMILY.member({value}, FAMILY.{potential}, 2, 2, 2), eps0)"


FAULTS = [
    ("21.loop", "scaled(s.kp, s.h) - scaled(s.kv, s.hw)", "scaled(s.kp, s.h) + scaled(s.kv, s.hw)"),
    ("21.5", "eps * kc * vd * a * b + eps * known.reach * kc * b**2", "eps * known.reach * kc * b**2"),
    ("21.9", "eps**2 * kc * vd * a**2 +", "eps**2 * kc * vd * a**2 / 2 +"),
    ("21.loop", FUNCTION, tracking("h(m, x) + 1", "potential(m, x)")),
    ("21.above", FUNCTION, tracking("-h(m, x)", "potential(m, x) * (-1)")),
    ("arm.21", "vd=SPEED)", "vd=2 * SPEED)"),
    ("21", FUNCTION, tracking("x", "x")),
]


@pytest.mark.parametrize(
    ("claim", "right", "wrong"), one_in(12, FAULTS), ids=[f"{row[0]}: {row[2]}" for row in FAULTS]
)
def test_a_planted_fault_is_not_proved(altered, claim, right, wrong):
    assert verdicts(altered(right, wrong), (claim,))[claim] in ("refuted", "undecided")


def test_claims_can_be_adopted_from_another_script(tmp_path):
    """With what they use, under their ids; what the script has already stays, and unknown ids are refused."""
    head = "from lyapcheck.claims import *\nproof = Proof('mine', 'mine')\n"
    own = "proof.add('h.bound', 'mine', Constant(expr(1) <= 2))\n"
    path = tmp_path / "mine.py"
    path.write_text(head + own + "proof.adopt('scalar.py', 'rate.5', section='Theirs')\n", encoding="utf-8")
    rows = {row.id: row for row in run_proof(path, ms=(1,), n=2).claims}
    assert {"rate.5", "rate", "V.smooth", "h.steep"} <= set(rows)
    assert (rows["h.bound"].statement, rows["h.bound"].comment) == ("1 ≤ 2", "mine")
    assert rows["rate.5"].section == "Theirs"
    path.write_text(head + "proof.adopt('scalar.py', 'rate.55')\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"did you mean rate\.5"):
        run_proof(path, ms=(1,), n=2)
