"""The report: one object, several documents, written whole."""

from __future__ import annotations

import pickle
import re
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields
from fractions import Fraction
from html.parser import HTMLParser
from multiprocessing import get_context
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree

import pytest

from lyapcheck.answers.gate.judge import judged_sets
from lyapcheck.answers.table import build_table
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.claims.decision import Decision
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.control.judgement import JudgedStatement
from lyapcheck.errors import InputError, argument_error
from lyapcheck.files.fields import file_stem
from lyapcheck.promise import Promise
from lyapcheck.report.build import write
from lyapcheck.report.findings import findings, own_findings
from lyapcheck.report.jobs import done
from lyapcheck.report.model import ClaimRow, EpsilonRow, anchor, published_notes
from lyapcheck.report.page import graph
from lyapcheck.report.verdict import badges, chain, route, sampled_section, sentences
from lyapcheck.verdicts import Grade, Verdict
from tests.helpers.heard import unnamed

VOID = {"meta", "link", "img", "br", "input"}


class Balance(HTMLParser):
    """Complains about tags that are closed in the wrong order, and collects links."""

    def __init__(self):
        super().__init__()
        self.open: list[str] = []
        self.targets: list[str] = []
        self.ids: set[str | None] = set()

    def handle_starttag(self, tag, attrs):
        self.ids.add(dict(attrs).get("id"))
        self.targets += [value or "" for key, value in attrs if key in ("href", "src")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def dead_links(page, files):
    """The links of a page to other files than these, or to no part of the page; all tags are closed."""
    reader = Balance()
    reader.feed(page)
    assert reader.open == []
    assert reader.targets
    parts = (target.partition("#") for target in reader.targets)
    return [
        f"{path}#{place}"
        for path, _, place in parts
        if unquote(path) not in {"", *files}
        or not (place in {"", *reader.ids} or re.fullmatch("[mp][0-9a-f]{10}", place))
    ]


def test_pages_are_balanced_and_their_links_lead_somewhere(files):
    pages = [page for name, page in files.items() if name.endswith(".html")]
    assert pages
    assert [dead_links(page, files) for page in pages] == [[]] * len(pages)


def test_everything_has_a_name_for_readers_of_the_screen(files):
    assert unnamed(files["index.html"]) == []


def test_the_page_is_one_file_and_asks_for_nothing(files):
    page = files["index.html"]
    assert not re.findall(r"<(?:link|img|iframe|object)\b|<script[^>]+src|@import|url\((?!#)", page)
    assert set(re.findall(r"https?://[^\s\"'<]+", page)) <= {
        "http://www.w3.org/1998/Math/MathML", "http://www.w3.org/1999/xlink", "http://www.w3.org/2000/svg"
    }  # fmt: skip


def test_the_first_screen_answers(report, files):
    first = files["index.html"].split('id="findings"')[0]
    assert report.notes.paper.title in first
    assert [badge.word for badge in badges(report)][:2] == ["proved for every n", "breaks at (16), term 6"]
    assert badges(report)[-1].word == "m = 1: stable at 2.5 ms under assumptions"
    (card,) = sampled_section(report)
    assert [len(getattr(block, "items", ())) for block in card.blocks] == [0, 7, 0]  # six, and k_g
    said = sentences(report)
    assert said[0].startswith("The proposition is true. It is proved")
    for words in ("every number of joints n", "every odd bounded function", "every real m ≥ 1", "(n = 2)"):
        assert words in said[0]
    assert "every number of joints" in first
    assert "breaks at (16), term 6" in said[1]
    assert [step.tone for step in chain(report)] == ["good", "good", "bad", "warn", "warn", "good", "open"]
    assert [step.tone for step in route(report)] == ["good"] * 3


def test_what_the_proposition_rests_on_weighs_most(report):
    weights = {name: one.weight for one in report.findings for name in one.claims}
    assert weights["16.6"] == weights["16"] == "A"
    assert {weights[name] for name in ("17a", "17c", "18", "8b")} == {"B"}
    assert {weights[name] for name in ("F.4.base", "T1.torque.pd.elbow")} == {"C"}
    assert [one.weight for one in report.findings] == sorted(one.weight for one in report.findings)


def test_equations_and_figures_are_wellformed_xml(files):
    equations = re.findall(r"<math.*?</math>", files["index.html"], re.DOTALL)
    assert len(equations) > 200
    for fragment in [*equations, *(text for name, text in files.items() if name.endswith(".svg"))]:
        ElementTree.fromstring(fragment)


def test_every_claim_has_its_equation_certificate_and_trust(report, files):
    page = files["index.html"]
    for row in report.every_claim:
        own = anchor(row.proof, row.id)
        body = page.split(f'<tr id="{own}"')[1].split("</tr>")[0]
        assert "<math" in body or not re.search("[≤γε]", row.comment)
        for used in row.uses:
            assert f'href="#{anchor(row.proof, used)}"' in body
        if row.decided:
            assert f'href="{row.certificate}"' in body
            assert row.certificate in report.certificates
            assert row.decision.rules
            assert row.decision.rules[0] in body
        assert f"| {row.id} |" in files["report.md"]


def test_no_clock_and_no_path_of_this_machine(files):
    here = str(Path(__file__).resolve().parents[2])
    for text in files.values():
        assert here not in text
        assert "<dc:date>" not in text


ONE = Resting("hyperbolic", 1, (Fraction(5),), (Fraction(0),), (Fraction(1),))
KEPT = Promise(ONE, JudgedStatement(ONE, None, "proved"))
"""A promise for rows put together by hand."""


def claim_row(
    name: str, verdict: str = "proved", witness: Any = None, grade: Grade = Grade.EXACT, **about: Any
) -> ClaimRow:
    """A claim of the paper of which nothing else is known."""
    kept = KEPT if verdict == "proved" else None
    decision = Decision(Verdict(verdict), grade, "", "open", witness, certificate=ONE, promise=kept)
    blank = {field.name: () if "tuple" in str(field.type) else "" for field in fields(ClaimRow)}
    words = {"section": "Section 3", "comment": "one is small", "m": None, "n": None, "gains": None}
    return ClaimRow(**blank | words | {"id": name, "decision": decision} | about)


def claim(claim_id, m, verdict, uses=()):
    witness = {"point": {"x": "3/2"}, "left": ["1.0", "1.0"], "operator": "<=", "right": ["0", "0"]}
    return claim_row(claim_id, m=m, verdict=verdict, uses=uses, witness=witness)


NOTES = published_notes()


def test_refuted_claims_become_one_finding_for_all_their_members():
    rows = [claim("a", 1, "refuted"), claim("a", 2, "refuted"), claim("b", 1, "proved")]
    result = findings(NOTES, rows)
    assert [(item.subject, item.ms, item.weight) for item in result] == [("claim a", (1, 2), "B")]
    assert "1 is not ≤ 0 at x = 3/2" in result[0].text


def test_a_refuted_claim_breaks_the_proof_where_the_proposition_rests_on_it():
    rows = [claim("a", 1, "refuted"), claim("b", 1, "proved", ("a",)), claim("P", 1, "undecided", ("b",))]
    assert [item.weight for item in findings(NOTES, rows)] == ["A"]


def epsilon_row(**about):
    blank = dict.fromkeys(field.name for field in fields(EpsilonRow))
    return EpsilonRow(**(blank | {"name": "a", "m": 2} | about))


@pytest.mark.parametrize(
    ("row", "count"),
    [
        (epsilon_row(published="0.1", certified="0.2", falsified="0.3"), 0),
        (epsilon_row(published="0.4", certified="0.2", falsified="0.3"), 1),
        (epsilon_row(certified="0.2", falsified="0.3"), 0),
    ],
)
def test_published_epsilons_are_held_against_the_others(row, count):
    assert len(findings(NOTES, [], [row])) == count


def test_a_report_names_the_packages_that_its_computations_loaded():
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        before = pool.submit(done, build_table, (1,)).result()
        after = pool.submit(done, exec, "import sympy").result()
    assert {"lyapcheck", "python-flint"} <= before.packages
    assert after.packages - before.packages == {"sympy"}


def gate_result(kp=1, kv=Fraction(1, 100)):
    """What the gate says of gains on the paper's arm."""
    gains = GainSet("a", 1, (Fraction(kp), *[Fraction(1)] * 2), (kv, *[Fraction(1, 100)] * 2))
    (result,) = judged_sets(GainFile("gains.toml", "buap3", (gains,)))
    return result


def test_two_names_of_gain_sets_never_become_one_file():
    names = "a b", "a_b", "a/b", "a%20b", "x" * 200, "x" * 201
    assert len(set(map(file_stem, names))) == len(names)


@pytest.mark.parametrize("name", ["../../etc/passwd", "a/b", "tau m1", "τ₃", "x" * 10])
def test_names_of_gain_sets_never_become_paths(name):
    assert re.fullmatch(r"[\w%-][\w.%-]*", file_stem(name))


def test_a_refused_write_leaves_the_old_report_whole(tmp_path):
    write({"report.md": "old"}, tmp_path)
    (tmp_path / "figures").write_text("in the way")
    with pytest.raises(InputError, match="cannot be written"):
        write({"figures/a.svg": "new", "report.md": "new"}, tmp_path)
    assert (tmp_path / "report.md").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["figures", "report.md"]


def test_a_refusal_in_another_process_comes_back_whole():
    refused = argument_error("--robot", "x", "is wrong", "mend it")
    again = pickle.loads(pickle.dumps(refused))
    assert isinstance(again, InputError)
    assert again.problems == refused.problems
    assert str(again) == str(refused)


@pytest.mark.parametrize("broken", ["19", "10p"])
def test_gains_that_break_19_alone_are_told_of_the_proof_where_there_is_one(broken):
    result = gate_result(1, Fraction(9, 10)) if broken == "19" else gate_result(99)
    (finding,) = own_findings([result], [epsilon_row(m=1)], [])
    assert ("--condition scalar accepts it" in finding.text) == (broken == "19")


def test_each_condition_that_breaks_is_named():
    (finding,) = own_findings([gate_result(99, Fraction(9, 10))], [epsilon_row(m=1)], [])
    assert finding.title == "a breaks (10p) and (19)"
    assert "(10p) base: " in finding.text
    assert "(19) base: " in finding.text


def test_the_graph_of_claims_shows_verdict_and_grade() -> None:
    second: dict[str, Any] = {"grade": Grade.ENCLOSURE, "uses": ["a"], "comment": "<b>"}
    rows = [
        claim_row("a", comment="<b>"),
        claim_row("b", **second),
        claim_row("c", "refuted", witness={"shown by": "it"}, broken=["a"], **second),
    ]
    drawn = graph(rows, {"a": "short"})
    boxes = ElementTree.fromstring(drawn).findall("a")
    assert [(box.get("href"), box.get("class")) for box in boxes] == [
        ("#a", "box proved exact"), ("#b", "box proved enclosure"), ("#c", "box refuted enclosure")
    ]  # fmt: skip
    said = [[text.text for text in box.findall("text")] for box in boxes]
    assert said == [["✓ a", "short"], ["✓ b"], ["✗ c"]]
    assert drawn.count("edge broken") == 1
    assert "<b>" not in drawn
