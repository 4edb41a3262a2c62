"""What the gate writes: six formats that others read, whatever the names hold."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree as ET

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from markdown_it import MarkdownIt

from lyapcheck.control import paper_gain_file, read_gain_file
from lyapcheck.files import printable
from lyapcheck.gating import GateResult, gate
from lyapcheck.gating.formats import FORMATS, renderer
from lyapcheck.gating.formats.words import significant_down

NASTY = [
    "<b>&amp;\"'</b>",
    "a|b|c",
    "`code` *bold* _it_ ~no~ [x](y) ![z](w) <!-- # -->",
    "a\nb\r\nc",
    "::error file=x,line=1::owned",
    "100%0A, a:b",
    "\x1b[31mred\x07\x00",
    "\u202egnp.exe \u2028 \ufffe \u00a0",
    "λ 关节 🦾",
    "\\",
    "]]>",
    "### heading",
    "@everyone #1",
]
NAMES = st.one_of(st.sampled_from(NASTY), st.text(min_size=1, max_size=12))


@pytest.fixture(scope="module")
def paper() -> list[GateResult]:
    return gate(read_gain_file(paper_gain_file("table2")))


@pytest.fixture(scope="module")
def undecided(tmp_path_factory: pytest.TempPathFactory) -> list[GateResult]:
    path = tmp_path_factory.mktemp("gate") / "g.toml"
    path.write_text("robot = 'pelican2'\n[[gains]]\nname = 'u'\nm = 2\nkp = [1, 1]\nkv = [0.001, 0.001]\n")
    return gate(read_gain_file(path))


def renamed(
    results: Sequence[GateResult], name: str, joint: str = "base", path: str = "g.toml"
) -> list[GateResult]:
    """The results with other names for the sets, the first joint and the file."""
    return [
        replace(
            result,
            file=replace(result.file, path=path),
            gains=replace(result.gains, name=name),
            limits=replace(result.limits, joints=(joint, *result.limits.joints[1:])),
        )
        for result in results
    ]


# --- all formats -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_input_gives_the_same_bytes(name: str) -> None:
    code = "from lyapcheck.cli.main import main; main()"
    words = ["gate", str(paper_gain_file("table2")), "--format", name]
    written = [
        subprocess.run(
            [sys.executable, "-c", code, *words],
            capture_output=True,
            check=False,
            env={"PYTHONHASHSEED": seed, "TZ": zone, "LC_ALL": "C"},
        ).stdout
        for seed, zone in (("1", "UTC"), ("2", "Asia/Tokyo"))
    ]
    assert written[0] == written[1]
    assert written[0].endswith(b"\n")
    assert written[0].decode() == renderer(name)(gate(read_gain_file(paper_gain_file("table2"))))


@pytest.mark.parametrize("name", FORMATS)
def test_each_format_tells_the_whole_outcome(name: str, paper: list[GateResult]) -> None:
    text = renderer(name)(paper)
    for part in ("tau_m2", "tau_m3", "0.223", "0.222", "0.210", "shoulder"):
        assert part in text


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_undecided_says_why(name: str, undecided: list[GateResult]) -> None:
    text = renderer(name)(undecided)
    assert "torque limit" in text
    assert "undecided" in text or name in ("junit", "sarif")


# --- JSON --------------------------------------------------------------------------------------------


def test_json_has_the_fields_that_scripts_rely_on(paper: list[GateResult]) -> None:
    document = json.loads(renderer("json")(paper))
    assert document["schema"] == "lyapcheck/gate/1"
    assert [(result["name"], result["m"], result["verdict"]) for result in document["results"]] == [
        ("tau_m1", 1, "accepted"),
        ("tau_m2", 2, "rejected"),
        ("tau_m3", 3, "rejected"),
    ]
    for result in document["results"]:
        assert [(check["id"], check["joint"]) for check in result["checks"]] == [
            ("10", None),
            *[("10p", joint) for joint in ("base", "shoulder", "elbow")],
            *[("19", joint) for joint in ("base", "shoulder", "elbow")],
        ]
        for check in result["checks"]:
            assert check.keys() >= {
                "id",
                "joint",
                "verdict",
                "value",
                "limit",
                "margin",
                "largest_admissible",
            }
            assert check["verdict"] in ("accepted", "rejected", "undecided")


def test_numbers_of_json_are_decimal_strings_that_enclose(paper: list[GateResult]) -> None:
    document = json.loads(renderer("json")(paper))
    for result, told in zip(paper, document["results"], strict=True):
        for check, shown in zip(result.checks, told["checks"], strict=True):
            assert check.limit is not None
            low, high = Fraction(shown["limit"]["lower"]), Fraction(shown["limit"]["upper"])
            assert low <= check.limit.lower <= check.limit.upper <= high
            assert high - low < Fraction(1, 10**15)
            assert Fraction(shown["value"]) == check.value
            assert Fraction(shown["margin"]) <= low - check.value + Fraction(1, 10**10)
            assert (Fraction(shown["margin"]) > 0) == (shown["verdict"] == "accepted")
            assert Fraction(shown["largest_admissible"]) == check.largest_admissible


def test_json_of_what_has_no_limit(undecided: list[GateResult]) -> None:
    (result,) = json.loads(renderer("json")(undecided))["results"]
    norm = result["checks"][0]
    assert (norm["verdict"], norm["limit"], norm["margin"], norm["largest_admissible"]) == (
        "undecided",
        None,
        None,
        None,
    )
    assert result["verdict"] == "undecided"


# --- JUnit -------------------------------------------------------------------------------------------


def test_junit_counts_what_it_lists(paper: list[GateResult], undecided: list[GateResult]) -> None:
    top = ET.fromstring(renderer("junit")([*paper, *undecided]))
    assert top.tag == "testsuites"
    assert [suite.get("name") for suite in top] == ["tau_m1", "tau_m2", "tau_m3", "u"]
    for suite in top:
        assert suite.get("tests") == str(len(suite.findall("testcase")))
        assert suite.get("failures") == str(len(suite.findall("testcase/failure")))
        assert suite.get("skipped") == str(len(suite.findall("testcase/skipped")))
    assert [suite.get("failures") for suite in top] == ["0", "3", "3", "0"]
    assert [suite.get("skipped") for suite in top] == ["0", "0", "0", "2"]
    failure = top.find("testsuite[2]/testcase/failure")
    assert failure is not None
    assert "lower it to at most 0.222" in (failure.get("message") or "")


# --- SARIF -------------------------------------------------------------------------------------------


def sarif(results: Sequence[GateResult]) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    log = json.loads(renderer("sarif")(results))
    assert log["version"] == "2.1.0"
    assert "sarif-2.1.0" in log["$schema"]
    (run,) = log["runs"]
    return run, run["results"]


def test_sarif_points_at_the_gain(paper: list[GateResult]) -> None:
    run, results = sarif(paper)
    lines = paper_gain_file("table2").read_text().splitlines()
    assert run["columnKind"] == "unicodeCodePoints"
    assert len(results) == 6
    for result in results:
        rule = run["tool"]["driver"]["rules"][result["ruleIndex"]]
        assert rule["id"] == result["ruleId"] == "condition-19"
        assert rule["shortDescription"]["text"]
        assert (result["level"], bool(result["message"]["text"])) == ("error", True)
        region = result["locations"][0]["physicalLocation"]["region"]
        line = lines[region["startLine"] - 1]
        assert line.startswith("kv")
        assert line[region["startColumn"] - 1 :].startswith("0.223")
    columns = [r["locations"][0]["physicalLocation"]["region"]["startColumn"] for r in results[:3]]
    assert len(set(columns)) == 3


def test_sarif_warns_of_what_is_undecided(undecided: list[GateResult]) -> None:
    _, results = sarif(undecided)
    assert {(result["level"], result["ruleId"]) for result in results} == {("warning", "condition-10p")}


def test_fingerprints_follow_the_gain_and_not_its_line(tmp_path: Path) -> None:
    path = tmp_path / "g.toml"
    text = paper_gain_file("table2").read_text()

    def prints(changed: str) -> list[str]:
        path.write_text(changed)
        return [r["partialFingerprints"]["gain/v1"] for r in sarif(gate(read_gain_file(path)))[1]]

    found = prints(text)
    assert len(set(found)) == 6
    assert prints("\n\n# moved\n" + text.replace("0.223", "0.229")) == found
    assert set(prints(text.replace("tau_m2", "other"))) & set(found) == set(found[3:])


def test_a_file_name_is_an_address_in_sarif(paper: list[GateResult]) -> None:
    for path in ("a b/ü#1%.toml", "c:x?.toml", "../g.toml"):
        for result in sarif(renamed(paper, "n", path=path))[1]:
            uri = result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
            assert re.fullmatch(r"[A-Za-z0-9._~/%-]+", uri)
            assert unquote(uri) == path


# --- GitHub ------------------------------------------------------------------------------------------

COMMAND = re.compile(r"::(error|warning|notice) ([^:]*)::(.*)")


def decoded(text: str) -> str:
    """As the runner of GitHub Actions reads a property or a message."""
    for code, sign in (("%0D", "\r"), ("%0A", "\n"), ("%3A", ":"), ("%2C", ","), ("%25", "%")):
        text = text.replace(code, sign)
    return text


def annotations(results: Sequence[GateResult]) -> list[tuple[str, dict[str, str], str]]:
    found = []
    for line in re.split(r"[\r\n]", renderer("github")(results))[:-1]:
        match = COMMAND.fullmatch(line)
        assert match, line
        pairs = (pair.split("=", 1) for pair in match[2].split(","))
        found.append((match[1], {key: decoded(value) for key, value in pairs}, decoded(match[3])))
    return found


def test_github_annotates_the_gain(paper: list[GateResult]) -> None:
    *found, notice = annotations(paper)
    errors, remarks = found[:6], found[6:]
    assert [kind for kind, _, _ in errors] == ["error"] * 6
    assert [(kind, place["line"]) for kind, place, _ in remarks] == [("notice", "13"), ("notice", "19")]
    assert all("only sufficient" in message for _, _, message in remarks)
    lines = paper_gain_file("table2").read_text().splitlines()
    for _, place, message in errors:
        assert place["file"] == str(paper_gain_file("table2"))
        assert lines[int(place["line"]) - 1][int(place["col"]) - 1 :].startswith("0.223")
        assert "k_v = 0.223 breaks" in message
    assert (notice[0], notice[2]) == ("notice", "1 of 3 gain sets accepted")


def test_github_warns_of_what_is_undecided(undecided: list[GateResult]) -> None:
    assert [kind for kind, _, _ in annotations(undecided)] == ["warning", "warning", "notice"]


# --- Markdown ----------------------------------------------------------------------------------------


class Page(HTMLParser):
    """The text of a rendered page: headings, rows of cells, items; and every tag that occurs."""

    def __init__(self, markdown: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.parts: dict[str, list[str]] = {}
        self._open: list[str] = []
        self.feed(MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(markdown))

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.tags.add(tag)
        self._open.append(tag)
        self.parts.setdefault(tag, []).append("")

    def handle_endtag(self, tag: str) -> None:
        self._open.pop()

    def handle_comment(self, data: str) -> None:
        raise AssertionError(f"a comment got in: {data}")

    def handle_data(self, data: str) -> None:
        if self._open:
            self.parts[self._open[-1]][-1] += data


def test_markdown_is_a_table_of_seven_columns(paper: list[GateResult]) -> None:
    page = Page(renderer("markdown")(paper))
    assert page.tags == {"h3", "table", "thead", "tbody", "tr", "th", "td", "ul", "li"}
    assert len(page.parts["td"]) == 7 * 7 * 3
    assert page.parts["th"][1:7] == ["condition", "joint", "value", "limit", "margin", "largest admissible"]
    assert "(19) k_v < λmin(B)/(√n γ)" in page.parts["td"]
    assert [row.split(": ")[-1] for row in page.parts["h3"]] == ["accepted", "rejected", "rejected"]
    assert len(page.parts["li"]) == 6 + 2
    assert sum("only sufficient" in item for item in page.parts["li"]) == 2


# --- names -------------------------------------------------------------------------------------------

ALL_NAMES = pytest.mark.parametrize("name", NASTY)


@ALL_NAMES
def test_names_survive_json_and_sarif(paper: list[GateResult], name: str) -> None:
    results = renamed(paper, name, name)
    document = json.loads(renderer("json")(results))
    assert all(result["name"] == name for result in document["results"])
    assert document["results"][0]["checks"][1]["joint"] == name
    assert all(result["message"]["text"].startswith(f"{name}: (19)") for result in sarif(results)[1])


@settings(max_examples=60, deadline=None)
@given(NAMES)
@example("a\nb\r\nc")
@example("\x00\ud7ff\ue000\uffff")
def test_names_survive_junit(paper: list[GateResult], name: str) -> None:
    """XML 1.0 has no control characters: those, and only those, come as escapes."""
    forbidden = r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"
    shown = re.sub(forbidden, lambda found: printable(found[0]), name)
    top = ET.fromstring(renderer("junit")(renamed(paper, name, name)))
    assert {suite.get("name") for suite in top} == {shown}
    assert top[0][0].get("name") == f"(10p) {shown}"
    assert top[0][0].get("classname") == f"g.toml.{shown}"


@settings(max_examples=60, deadline=None)
@given(NAMES)
@example("::error file=x,line=1::owned")
@example("%0A\n%250A\r")
def test_names_survive_github(paper: list[GateResult], name: str) -> None:
    shown = "".join(c if c in "\r\n" else printable(c) for c in name)
    *errors, _, _, _ = annotations(renamed(paper, name, name, path=name))
    assert [kind for kind, _, _ in errors] == ["error"] * 6
    for _, place, _ in errors:
        assert place.keys() == {"file", "line", "col", "title"}
        assert place["title"] == f"{shown}: rejected"
        assert place["file"] == shown
    assert errors[0][2].startswith(f"(19) {shown}: k_v")


@settings(max_examples=60, deadline=None)
@given(NAMES)
@example("&lt; a|b \\| ` <i>_x_</i> ~~s~~ http://x.y <http://x.y>")
def test_names_survive_markdown(paper: list[GateResult], name: str) -> None:
    """The page shows the names as they are, in one cell, and no tag of theirs."""
    page = Page(renderer("markdown")(renamed(paper, name, name)))
    assert page.tags == {"h3", "table", "thead", "tbody", "tr", "th", "td", "ul", "li"}
    assert len(page.parts["td"]) == 7 * 7 * 3
    shown = printable(name)
    assert page.parts["td"][9] == shown.strip()
    assert page.parts["h3"][0] == f"✓ {shown} (m = 1): accepted"
    assert page.parts["li"][0].startswith(f"(19) {shown}: k_v")


@settings(max_examples=60, deadline=None)
@given(NAMES)
def test_names_stay_on_their_line_in_a_terminal(paper: list[GateResult], name: str) -> None:
    plain = renderer("text")(renamed(paper, "n", "j"))
    text = renderer("text")(renamed(paper, name, name, path=name))
    assert text.replace("\n", "").isprintable()
    assert text.count("\n") == plain.count("\n")
    assert f"✓ {printable(name)}: accepted" in text


# --- the terminal ------------------------------------------------------------------------------------


def test_columns_of_the_text_line_up(paper: list[GateResult]) -> None:
    block = renderer("text")(paper).splitlines()[1:9]
    starts = {re.search(r"base|shoulder|elbow|all|joint", line).start() for line in block}  # type: ignore[union-attr]
    assert len(starts) == 1


def test_the_last_line_counts(paper: list[GateResult], undecided: list[GateResult]) -> None:
    assert renderer("text")(paper).endswith("\n1 accepted, 2 rejected\n")
    assert renderer("text")([*paper, *undecided]).endswith("\n1 accepted, 2 rejected, 1 undecided\n")


@given(st.fractions(), st.integers(1, 12))
def test_a_margin_is_never_shown_larger_than_it_is(value: Fraction, digits: int) -> None:
    shown = Fraction(significant_down(value, digits))
    assert shown <= value
    if value:
        assert value - shown <= max(abs(value) * Fraction(10) ** (1 - digits), Fraction(1, 10**40))


def test_what_to_change_would_pass(tmp_path: Path) -> None:
    """Doing what each message says makes the gate accept."""
    path = tmp_path / "g.toml"
    kp, kv = ["29.5", "60.5", "9.5"], ["0.3", "0.3", "0.3"]
    for _ in range(3):
        path.write_text(
            f"robot = 'buap3'\n[[gains]]\nname = 'a'\nm = 2\nkp = [{', '.join(kp)}]\nkv = [{', '.join(kv)}]\n"
        )
        (result,) = gate(read_gain_file(path))
        told = [item["message"]["text"] for item in sarif([result])[1]]
        for check, text in zip(result.failures, told, strict=True):
            assert check.joint is not None
            changed = re.search(r"lower (k_p|it) to at most ([0-9.]+)$", text)
            assert changed, text
            (kp if changed[1] == "k_p" else kv)[check.joint] = changed[2]
    assert result.verdict == "accepted"


# --- Python and notebooks ------------------------------------------------------------------------------


def test_results_print_as_the_command_does(paper: list[GateResult]) -> None:
    assert str(gate(read_gain_file(paper_gain_file("table2")))) == renderer("text")(paper)
    assert str(paper[1]) == renderer("text")([paper[1]])


def test_results_show_themselves_in_a_notebook(paper: list[GateResult]) -> None:
    class Tags(HTMLParser):
        def __init__(self) -> None:
            super().__init__()
            self.found: list[str] = []

        def handle_starttag(self, tag: str, attrs: object) -> None:
            self.found.append(tag)

    tags = Tags()
    shown = gate(read_gain_file(paper_gain_file("table2")))._repr_html_()
    tags.feed(shown)
    assert set(tags.found) == {"table", "caption", "thead", "tbody", "tr", "th", "td", "p"}
    assert (tags.found.count("table"), tags.found.count("td")) == (3, 3 * 7 * 7)
    assert "✗ tau_m2: rejected" in shown
    assert "lower it to at most 0.222" in shown
    assert "<b>" not in renamed(paper, "<b>x</b>", "<b>")[0]._repr_html_()
