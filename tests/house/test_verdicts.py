"""Nobody but the checker makes a verdict: where else one is written down, and is not only asked for."""

import ast
import re

import pytest

from tests.house.test_house import modules

WORDS = ("proved", "refuted", "accepted", "rejected", "certified", "stable")
MAKERS = ("Verdict", "JudgedStatement", "Judgement", "Accepted")
"""What makes a verdict of a word that need not stand in the source."""
FIELDS = ("verdict", "shown")
"""Where what the checker said is kept."""
QUOTED = re.compile(rf"""["'](?:{"|".join(WORDS)})["']""")
"""A verdict inside a text, as in JSON that is written by hand."""
LOOKED_AT = (ast.expr, ast.ImportFrom, ast.Assign, ast.AugAssign)
LOOKING_UP = ("getattr", "setattr", "vars", "attrgetter", "methodcaller", "import_module")
GENERIC = ("Mapping", "dict", "list", "tuple", "Callable", "Iterable", "Iterator", "Sequence")
HEADING, SORTING, COLOURS = "a heading or a label", "an order in which verdicts are shown", "colours of words"
CERTIFICATE = "a certificate, which recheck judges"
GATHERED = "gathered from the verdicts of checks"
SAID = {
    "answers.bounds": (1, CERTIFICATE),
    "answers.check": (5, "an order of verdicts, and a word that promises alone may say"),
    "answers.export": (2, "a word that promises alone may say"),
    "answers.epsilon": (2, "headings, and a sentence that promises alone may say"),
    "answers.epsilon.result": (2, HEADING),
    "answers.epsilon.kept": (5, f"{CERTIFICATE}, and what the checker said when it was taken"),
    "answers.gate": (1, GATHERED),
    "answers.gate.document": (4, SORTING),
    "answers.gate.judge": (2, GATHERED),
    "answers.gate.words": (1, "the word of a check that is accepted, said by its promise"),
    "answers.gate.certificates": (2, CERTIFICATE),
    "answers.recheck": (2, SORTING),
    "answers.robot": (3, "a heading, and a word that promises alone may say"),
    "answers.sweep.questions": (3, "the words for the exit codes of answers, and the name of a reason"),
    "claims.decision": (1, "what a fresh process of the checker said"),
    "claims.procedures": (1, "what parts are looked at for"),
    "claims.search_result": (2, "what a search proposes, which the rules are asked about before it is shown"),
    "answers.check.run": (1, "what a search proposed before, which a fresh process of the checker judges"),
    "cli.commands.simulate": (1, "the word of an option"),
    "cli.task": (5, "the word of an option"),
    "control.conditions": (2, "names handed on"),
    "control.judgement": (8, "the words of the gate for what the checker says there"),
    "kernel.statements": (2, "the name of a predicate in Coq"),
    "output.text": (4, COLOURS),
    "rechecking": (3, SORTING),
    "report.compare": (4, SORTING),
    "report.document": (1, HEADING),
    "report.model": (3, SORTING),
    "report.page": (1, "an order of verdicts"),
    "report.tiles": (2, "a word that promises alone may say"),
    "report.verdict": (3, "gathered, and a sentence that promises alone may say"),
    "verdicts": (6, "the words themselves, and exit codes"),
}
"""Modules in which verdicts are written down: how often, and what for."""


def made(source):
    """The places of a source that write a verdict down, other than to compare with it or to look it up."""
    tree = ast.parse(source)
    above = {part: node for node in ast.walk(tree) for part in ast.iter_child_nodes(node)}
    looked_at = ((node, user) for node, user in above.items() if isinstance(node, LOOKED_AT))
    for node, user in looked_at:
        if _says(node, above) and not _asks(node, above) and not _says(user, above):
            yield f"{node.lineno}: {ast.unparse(user)[:90]}"


def _says(node, above):
    """Whether a node is a verdict, or makes one of something else."""
    return _is_word(node, above) or _makes(node, above) or _overwrites(node)


def _is_word(node, above):
    """A verdict by its name, as text that constants make in whatever way, or quoted inside one."""
    if isinstance(node, (ast.Name, ast.Attribute)):
        name = node.id if isinstance(node, ast.Name) else node.attr
        if not name.isupper() or name.lower() not in WORDS:
            return False
        is_exit = isinstance(node, ast.Attribute) and ast.unparse(node.value) == "Exit"
        return not is_exit or isinstance(above.get(node), ast.Attribute)  # Exit.PROVED.name is a word again
    text = "" if isinstance(above.get(node), ast.Expr) else _text(node)  # documentation
    return text.lower() in WORDS or bool(QUOTED.search(text))


def _text(node):
    """What a constant says, or the constants of a text with holes; empty where it is no text."""
    parts = node.values if isinstance(node, ast.JoinedStr) else [node]
    known = [part.value for part in parts if isinstance(part, ast.Constant)]
    return "".join(
        value.decode("utf-8", "replace") if isinstance(value, bytes) else value
        for value in known
        if isinstance(value, str | bytes)
    )


def _makes(node, above):
    """One of the makers in any other place than a type: called, handed on, or under another name."""
    if isinstance(node, ast.ImportFrom):
        return any(part.asname and part.name in (*MAKERS, "Exit") for part in node.names)
    if isinstance(node, ast.Constant):
        user = above[node]
        looked_up = isinstance(user, ast.Subscript) and isinstance(user.value, (ast.Call, ast.Attribute))
        return node.value in MAKERS and (looked_up or _called(user) in LOOKING_UP)
    if isinstance(node, ast.Call):
        of_type = isinstance(node.func, ast.Call) and _called(node.func) == "type"
        return _called(node) == "__class__" or (of_type and "verdict" in ast.unparse(node.func))
    name = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""
    if name not in MAKERS or _is_type(node, above):
        return False
    user = above[node]
    return not (isinstance(user, ast.Attribute) and user.attr.isupper())


def _called(node):
    """The last name of what a call calls."""
    function = node.func if isinstance(node, ast.Call) else None
    return function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")


def _is_type(node, above):
    """Whether a name stands in an annotation, or to ask what something is."""
    below = node
    while (user := above.get(below)) is not None and not isinstance(below, ast.stmt):
        if isinstance(user, ast.AnnAssign) and below is user.annotation:
            return True
        if isinstance(user, ast.arg) or (isinstance(user, ast.FunctionDef) and below is user.returns):
            return True
        if isinstance(user, ast.ClassDef) and below in user.bases:
            return True
        if isinstance(user, ast.Call) and below in user.args:
            return isinstance(user.func, ast.Name) and user.func.id in ("isinstance", "issubclass", "cast")
        if isinstance(user, ast.Assign):  # Kinds = Mapping[str, Verdict] is a type as well
            return isinstance(below, ast.Subscript) and ast.unparse(below.value) in GENERIC
        below = user
    return False


def _overwrites(node):
    """The verdict of what the checker has said, put in from elsewhere."""
    called = _called(node)
    if called == "replace":
        return any(part.arg in FIELDS for part in node.keywords)  # type: ignore[attr-defined]
    if called in ("setattr", "__setattr__"):
        return any(_text(part) in FIELDS for part in node.args)  # type: ignore[attr-defined]
    if isinstance(node, (ast.Assign, ast.AugAssign)):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        of_others = (one for one in targets if isinstance(one, ast.Attribute))
        return any(one.attr in FIELDS and ast.unparse(one.value) != "self" for one in of_others)
    return False


def _asks(node, above):
    """Whether a verdict stands where one is compared with it, looked up by it, or told how to sort."""
    below = node
    while (whole := above.get(below)) is not None and not isinstance(below, ast.stmt):
        if isinstance(whole, (ast.Compare, ast.MatchValue)):
            return True
        if isinstance(whole, ast.Dict) and below in whole.keys:
            return True
        if isinstance(whole, ast.Subscript) and below is whole.slice and not _makes(whole.value, above):
            return not _makes(node, above)
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
    "by its name": "found = Verdict['PROVED']",
    "by getattr": "found = getattr(Verdict, name)",
    "another name": "from lyapcheck.verdicts import Verdict as V\nfound = V.PROVED",
    "a constant of the gate": "found = replace(check, shown=ACCEPTED)",
    "in a table": "ROWS = [('arm', 'certified')]",
    "as data": "data = {'verdict': 'accepted'}",
    "an attribute": "row.verdict = 'refuted'",
    "a default": "def f(verdict='proved'):\n    return verdict",
    "a field": "class Row:\n    verdict: str = 'proved'",
    "a yield": "def f():\n    yield 'proved'",
    "a lambda": "verdict = lambda gap: 'proved' if gap > 0 else ''",
    "an update": "row.update(verdict='proved')",
    "made of a word of others": "found = verdicts.Verdict(text)",
    "an alias": "V = Verdict\nfound = V(text)",
    "a mapped maker": "found = list(map(Verdict, words))",
    "a partial": "make = partial(JudgedStatement, statement)",
    "renamed as an exit code": "from lyapcheck.verdicts import Verdict as Exit\nfound = Exit.PROVED",
    "renamed": "from lyapcheck.control.judgement import JudgedStatement as J\nfound = J(statement, None, s)",
    "by its members": "found = Verdict.__members__[name]",
    "the first of them": "found = next(iter(Verdict))",
    "of its class": "found = row.verdict.__class__(word)",
    "of its type": "found = type(row.verdict)(word)",
    "by getattr of a module": "found = getattr(verdicts, 'Verdict')(word)",
    "by globals": "found = globals()['Verdict'](word)",
    "by replace": "found = dataclasses.replace(judgement, shown=word)",
    "by object": "object.__setattr__(judgement, 'shown', word)",
    "as bytes": "text = b'proved'",
    "json by hand": 'text = \'{"verdict": "proved"}\'',
    "json with a hole": 'text = f\'{{"id": "{name}", "verdict": "proved"}}\'',
    "an exit code's name": "text = Exit.PROVED.name.lower()",
    "from a mapping": "WORDS = {True: 'proved', False: 'refuted'}",
}


@pytest.mark.parametrize("name", DISGUISES)
def test_a_maker_of_verdicts_is_found_in_any_disguise(name):
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
        "def f(row: JudgedStatement) -> Verdict:\n    return row.verdict",
        "ok = isinstance(found, JudgedStatement)",
        "ok = replace(row, name=name)",
    ],
)
def test_who_only_asks_is_left_alone(source):
    assert [one for one in made(source) if '"""' not in source] == []


def test_nobody_but_the_checker_makes_a_verdict():
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
