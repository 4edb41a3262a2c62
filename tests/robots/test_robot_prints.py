"""C and g as a source prints them, compared with what M and the potential give."""

from dataclasses import replace

import numpy as np
import pytest

from lyapcheck.answers.robot.properties import answered, certificates, print_questions
from lyapcheck.claims.decision import judge_afresh
from lyapcheck.errors import InputError
from lyapcheck.robots import load
from tests.robots.test_arm_files import CHAIN, PRINTED

pytestmark = pytest.mark.usefixtures("in_this_process")

CHRISTOFFEL = """
[printed]
C11 = [[-1, "b s2 w2"]]
C12 = [[-1, "b s2 w1"], [-1, "b s2 w2"]]
C21 = [[1, "b s2 w1"]]
C22 = []
g1 = [[38.46501, "s1"], [1.82466, "s12"]]
g2 = [[1.82466, "s1 c2"], [1.82466, "c1 s2"]]
"""


def arm(folder, old="", new="", text=PRINTED):
    file = folder / "arm.toml"
    file.write_text(text + CHRISTOFFEL.replace(old, new) if old else text + CHRISTOFFEL, encoding="utf-8")
    return load(file)


def print_claims(model):
    asked = list(print_questions(model))
    made = certificates(model, asked)
    rows = answered(model, asked, made, judge_afresh(made))
    return [replace(row, id=row.id.removeprefix("printed ")) for row in rows]


def verdicts(model):
    return {row.id: row.verdict.value for row in print_claims(model)}


def test_the_christoffel_symbols_themselves_meet_every_claim(tmp_path):
    assert verdicts(arm(tmp_path)) == {"C torque": "proved", "C rates": "proved", "g": "proved"}


def test_reyes_and_kelly_print_the_same_torque_in_another_matrix():
    """C₁₁ = −2b sin(q₂) q̇₂ and C₁₂ = −b sin(q₂) q̇₂: the same C q̇, but Ṁ₁₁ = −2b sin(q₂) q̇₂ ≠ 2 C₁₁."""
    model = load("reyes-kelly2")
    assert verdicts(model) == {"C torque": "proved", "C rates": "refuted", "g": "proved"}
    witness = next(row for row in print_claims(model) if row.id == "C rates").finding.witness
    assert witness is not None
    q2 = eval_fraction(witness["point"]["q2"])
    assert (witness["point"]["w1"], witness["point"]["w2"], witness["right"]) == ("0", "1", ["0", "0"])
    # Ṁ11 − 2 C11 along w2 = 1
    assert float(witness["left"][0]) == pytest.approx((4 - 2) * 0.084 * np.sin(q2), rel=1e-9)


def eval_fraction(text):
    numerator, _, denominator = text.partition("/")
    return int(numerator) / int(denominator or 1)


@pytest.mark.parametrize(
    ("old", "new", "refuted"),
    [
        ('C21 = [[1, "b s2 w1"]]', 'C21 = [[-1, "b s2 w1"]]', {"C torque", "C rates"}),
        ("C22 = []", 'C22 = [[1e-9, "s1 w1"]]', {"C torque", "C rates"}),
        # moved from one side of the diagonal to the other along w1 w2, the torque stays
        ('C11 = [[-1, "b s2 w2"]]', 'C11 = [[-1, "b s2 w2"], [1, "c1 w2"]]', {"C torque", "C rates"}),
        ('g2 = [[1.82466, "s1 c2"]', 'g2 = [[1.82465, "s1 c2"]', {"g"}),
        ('g1 = [[38.46501, "s1"]', 'g1 = [[38.46501, "c1"]', {"g"}),
    ],
)
def test_a_slip_in_the_print_is_refuted(tmp_path, old, new, refuted):
    result = verdicts(arm(tmp_path, old, new))
    assert {name for name, verdict in result.items() if verdict == "refuted"} == refuted


def test_with_a_range_the_claims_are_about_all_values(tmp_path):
    wide = PRINTED.replace("b = 0.084", "b = { value = 0.084, low = 0.08, high = 0.09 }")
    assert set(verdicts(arm(tmp_path, text=wide)).values()) == {"proved"}
    fixed_number = arm(tmp_path, '[[1, "b s2 w1"]]', '[[0.084, "s2 w1"]]', text=wide)
    assert verdicts(fixed_number)["C torque"] == "refuted"
    witness = print_claims(fixed_number)[0].finding.witness
    assert witness is not None
    assert witness["point"]["b"] in ("0.08", "0.09")


BROKEN = [
    (
        "C22 = []",
        'C22 = [[1, "s2"]]',
        'printed.C22[1] = [1, "s2"]: must have exactly one of the rates w1 … w2',
    ),
    ("C22 = []", 'C22 = [[1, "s2 w1 w2"]]', "must have exactly one of the rates w1 … w2"),
    ("C22 = []", 'C22 = [[1, "s2 w3"]]', "must have exactly one of the rates w1 … w2"),
    ("C22 = []", 'C22 = [[1, "s3 w1"]]', "'s3' speaks of a joint that this arm of 2 does not have"),
    ("C22 = []", 'C22 = [["1", "s2 w1"]]', "must be a finite decimal number"),
    ("C22 = []", "C22 = 0", "printed.C22 = 0: must be a list of at most 1000 terms"),
    ("C22 = []\n", "", "printed.C22: is missing"),
    ("C22 = []", "C22 = []\nC33 = []", "printed.C33 = []: is not a known key here"),
    ('g1 = [[38.46501, "s1"], [1.82466, "s12"]]\n', "", "printed.g1: is missing"),
    ('g1 = [[38.46501, "s1"]', 'g1 = [[38.46501, "s1 w1"]', "'w1' is neither a sine, a cosine nor an entry"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BROKEN)
def test_a_broken_print_is_told(tmp_path, old, new, expected):
    assert old in CHRISTOFFEL
    with pytest.raises(InputError) as caught:
        arm(tmp_path, old, new)
    assert expected in str(caught.value)


def test_a_print_without_terms_or_beside_links_is_told(tmp_path):
    file = tmp_path / "arm.toml"
    for text, rule in (
        (PRINTED + "\n[printed]\n", "has no C11 … and no g1 …"),
        (CHAIN + CHRISTOFFEL, "does not go together with [[links]]"),
    ):
        file.write_text(text, encoding="utf-8")
        with pytest.raises(InputError) as caught:
            load(file)
        assert rule in str(caught.value)
