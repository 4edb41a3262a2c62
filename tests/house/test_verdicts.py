"""Nobody but the checker makes a verdict: where else one is written down, and is not only asked for."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from tests.house.test_house import modules

WORDS = ("proved", "refuted", "accepted", "rejected", "certified", "stable")
MAKERS = ("Verdict", "Judgement", "Accepted")
"""What makes a verdict of a word that need not stand in the source."""
HEADING, SORTING, COLOURS = "a heading or a label", "an order in which verdicts are shown", "colours of words"
CERTIFICATE = "a certificate, which recheck judges"
GATHERED = "gathered from the verdicts of checks"
SAID = {
    "answers.bounds.answer": (1, HEADING),
    "answers.bounds.certificates": (1, CERTIFICATE),
    "answers.check.proof": (2, SORTING),
    "answers.epsilon.annotations": (4, "the name of a rule"),
    "answers.epsilon.certificates": (4, CERTIFICATE),
    "answers.epsilon.words": (1, HEADING),
    "answers.gate.answer": (5, GATHERED),
    "answers.gate.judge": (2, GATHERED),
    "answers.gate.whole": (2, CERTIFICATE),
    "answers.recheck": (2, SORTING),
    "answers.robot.report": (1, HEADING),
    "answers.sweep.question": (2, "the words for the exit codes of answers"),
    "answers.sweep.result": (2, SORTING),
    "claims.decision": (1, "what a fresh process of the checker said"),
    "claims.search_result": (3, "what a search proposes, which the rules are asked about before it is shown"),
    "claims.run": (1, "what a search proposed before, which a fresh process of the checker judges"),
    "claims.smallest": (1, CERTIFICATE),
    "cli.eps0": (4, "the word of an option"),
    "cli.task": (1, "the word of an option"),
    "control.conditions": (2, "names handed on"),
    "control.judgement": (8, "the words of the gate for what the checker says there"),
    "kernel.statements": (2, "the name of a predicate in Coq"),
    "output.text": (4, COLOURS),
    "report.compare": (5, SORTING),
    "report.document": (2, HEADING),
    "report.drawings": (1, HEADING),
    "report.figures.constants": (1, HEADING),
    "report.jobs": (1, HEADING),
    "report.kept": (2, "what a fresh process of the checker must say"),
    "report.model": (2, SORTING),
    "report.page.claims": (2, SORTING),
    "report.verdict": (3, GATHERED),
    "simulate.batch_numpy": (1, "steps of an integrator"),
    "verdicts": (6, "the words themselves, and exit codes"),
}
"""Modules in which verdicts are written down: how often, and what for."""


def made(source: str) -> Iterator[str]:
    """The places of a source that write a verdict down, other than to compare with it or to look it up."""
    tree = ast.parse(source)
    above = {part: node for node in ast.walk(tree) for part in ast.iter_child_nodes(node)}
    for node in ast.walk(tree):
        if _says(node) and not _asks(node, above):
            yield f"{node.lineno}: {ast.unparse(above[node])[:90]}"  # type: ignore[attr-defined]


def _says(node: ast.AST) -> bool:
    """Whether a node is a verdict, or makes one of something else."""
    if isinstance(node, (ast.Name, ast.Attribute)):
        name = node.id if isinstance(node, ast.Name) else node.attr
        is_exit = isinstance(node, ast.Attribute) and ast.unparse(node.value) == "Exit"
        return name.isupper() and name.lower() in WORDS and not is_exit
    if isinstance(node, (ast.Constant, ast.BinOp, ast.JoinedStr)):
        return _text(node).lower() in WORDS
    called = node.func if isinstance(node, ast.Call) else None
    if isinstance(node, ast.Subscript):
        called = node.value
    if called is not None and ast.unparse(called).rpartition(".")[2] in MAKERS:
        return True
    made_of = isinstance(node, ast.Call) and ast.unparse(node.func) in ("getattr", "setattr", "vars")
    return made_of and any(ast.unparse(part).rpartition(".")[2] in MAKERS for part in node.args)  # type: ignore[attr-defined]


def _text(node: ast.AST) -> str:
    """The text that constants make together; empty where it is none."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    if isinstance(node, ast.BinOp):
        return _text(node.left) + _text(node.right)
    if isinstance(node, ast.JoinedStr):
        return "".join(map(_text, node.values))
    return _text(node.value) if isinstance(node, ast.FormattedValue) else ""


def _asks(node: ast.AST, above: dict[ast.AST, ast.AST]) -> bool:
    """Whether a verdict stands where one is compared with it, looked up by it, or told how to sort."""
    below = node
    while (whole := above.get(below)) is not None and not isinstance(below, ast.stmt):
        if isinstance(whole, (ast.Compare, ast.MatchValue)):
            return True
        if isinstance(whole, ast.Dict) and below in whole.keys:
            return True
        if isinstance(whole, ast.Subscript) and below is whole.slice and not _says(whole):
            return True
        if isinstance(whole, ast.keyword) and whole.arg == "kind":
            return True
        if isinstance(whole, (ast.Call, ast.Lambda, ast.IfExp, ast.comprehension)):
            break
        below = whole
    return False


DISGUISES = {
    "handed on": "found = Decision(Verdict.PROVED, grade)",
    "a word": "row = Row(verdict='proved')",
    "returned": "def f():\n    return Verdict.REFUTED",
    "a variable": "def f(ok):\n    verdict = Verdict.PROVED if ok else Verdict.UNDECIDED\n    return verdict",
    "a choice": "show('proved' if eps > 0 else 'undecided')",
    "by its value": "found = Verdict('pro' + 'ved')",
    "by its name": "found = Verdict['PROVED']",
    "by getattr": "found = getattr(Verdict, name)",
    "another name": "from lyapcheck.verdicts import Verdict as V\nfound = V.PROVED",
    "a constant of the gate": "found = replace(check, shown=ACCEPTED)",
    "in a table": "ROWS = [('arm', 'certified')]",
    "as data": "data = {'verdict': 'accepted'}",
    "an attribute": "row.verdict = 'refuted'",
    "a default": "def f(verdict='proved'):\n    return verdict",
    "a field": "class Row:\n    verdict: str = 'proved'",
    "in pieces": "text = f'{\"sta\"}ble'",
    "a yield": "def f():\n    yield 'proved'",
    "a lambda": "verdict = lambda gap: 'proved' if gap > 0 else ''",
    "an update": "row.update(verdict='proved')",
    "made of a word of others": "found = verdicts.Verdict(text)",
    "from a mapping": "WORDS = {True: 'proved', False: 'refuted'}",
}


@pytest.mark.parametrize("name", DISGUISES)
def test_a_maker_of_verdicts_is_found_in_any_disguise(name: str) -> None:
    assert list(made(DISGUISES[name]))


@pytest.mark.parametrize(
    "source",
    [
        "ok = row.verdict is Verdict.PROVED",
        "ok = row.verdict in ('proved', 'refuted')",
        "sign = {'proved': '✓'}[verdict]",
        "value = row['certified']",
        "order = np.argsort(x, kind='stable')",
        "raise typer.Exit(Exit.PROVED)",
        '"""proved"""\nx = 1',
        "ok = Verdict.PROVED in found",
    ],
)
def test_who_only_asks_is_left_alone(source: str) -> None:
    assert [one for one in made(source) if '"""' not in source] == []


def test_nobody_but_the_checker_makes_a_verdict() -> None:
    outside = [name for name in modules() if not name.startswith("lyapcheck.check")]
    result = {name: list(made(modules()[name].read_text(encoding="utf-8"))) for name in outside}
    counted = {name: len(places) for name, places in result.items() if places}
    wanted = {f"lyapcheck.{name}": count for name, (count, _) in SAID.items()}
    assert counted == wanted, "\n".join(
        f"{name} {place}"
        for name in sorted(result)
        if counted.get(name) != wanted.get(name)
        for place in result[name]
    )
    assert any(made(modules()["lyapcheck.check.kinds.identity"].read_text(encoding="utf-8")))
