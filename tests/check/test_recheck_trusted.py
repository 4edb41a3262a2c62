"""``recheck --trusted``: the code that each kind of verdict rests on, by name, so that growth is noticed."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from lyapcheck.check.codec import name_of
from lyapcheck.check.trusted import CORE, closure, imported, lines, modules, source
from lyapcheck.check.verify import RULES

GOLDEN = Path(__file__).parents[1] / "golden" / "trusted.txt"
HEADLINES = (
    "Identity by normal form",
    "EveryN by normal form",
    "BoundEveryN by covered terms",
    "MassAbove by links",
    "Decreasing by M positive and V decreasing",
    "LoopProperty by facts in one variable",
    "Theorem by theorem",
)
PREMISES = [("premises", "lyapcheck.check.theorems.premises")]


def entered():
    return {f"{name_of(kind)} by {name_of(by)}": judge.__module__ for (kind, by), judge in RULES.items()}


def listed():
    """The modules of each headline verdict beyond the core, by name, as in the golden file."""
    rules, text = entered(), "core\n" + "".join(f"  {name}\n" for name in sorted(CORE))
    for headline in HEADLINES:
        named = (
            [(headline, rules[headline]), *PREMISES]
            if headline.startswith("Theorem")
            else [("", rules[headline])]
        )
        found = set(modules(named)) - set(CORE)
        text += f"{headline}\n" + "".join(f"  {name}\n" for name in sorted(found))
    return text.replace("  lyapcheck.check.", "  ")


def test_the_trusted_code_of_headline_verdicts_has_not_grown():
    """To accept growth: ``python -m tests.check.test_recheck_trusted`` writes the file anew."""
    assert listed() == GOLDEN.read_text(encoding="utf-8")


def test_what_is_listed_is_what_a_process_imports_for_a_rule():
    """Importing the module of a rule without its package loads nothing of the checker that is not listed."""
    code = """
import sys, types, importlib
for name in ("lyapcheck", "lyapcheck.check", "lyapcheck.check.kinds"):
    found = importlib.util.find_spec(name)
    module = types.ModuleType(name)
    module.__path__ = list(found.submodule_search_locations)
    sys.modules[name] = module
importlib.import_module(sys.argv[1])
print(*(name for name in sys.modules if name.startswith("lyapcheck.check.")))
"""
    for name in ("decreasing", "identity", "bound_every_n"):
        module = f"lyapcheck.check.kinds.{name}"
        done = subprocess.run(
            [sys.executable, "-c", "import importlib.util\n" + code, module],
            capture_output=True,
            text=True,
            check=True,
        )
        packages = {"lyapcheck.check.kinds"}
        loaded = {one for one in done.stdout.split() if source(one).name != "__init__.py"} - packages
        assert loaded <= set(modules([("", module)]))


def test_every_module_that_is_named_exists_and_the_core_is_real():
    assert all(source(name).is_file() for name in CORE)
    for module in set(entered().values()):
        assert module in closure(module)
        assert all(source(name).is_file() and lines(name) >= 0 for name in closure(module))
    assert "lyapcheck.check.loop.schur" in closure("lyapcheck.check.kinds.decreasing")
    assert "lyapcheck.check.letters.words" in imported("lyapcheck.check.kinds.every_n")


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """What recheck says of a proof with theorems, as text and as data."""
    made = tmp_path_factory.mktemp("made")
    check = "import sys; sys.argv[0] = 'lyapcheck'; from lyapcheck.cli.main import main; main()"
    arguments = ("check", "scalar.py", "--m", "2", "--only", "arms.all", "--certificates", str(made))
    subprocess.run([sys.executable, "-c", check, *arguments], capture_output=True, check=True)
    command = [sys.executable, "-m", "lyapcheck.check", str(made), "--trusted"]
    text, data = (
        subprocess.run([*command, "--format", form], capture_output=True, text=True, check=True).stdout
        for form in ("text", "json")
    )
    return text, json.loads(data)


def test_a_theorem_rests_on_the_rules_of_its_premises_too(shown):
    text, data = shown
    rows = {row["file"]: row["rules"] for row in data["certificates"]}
    assert {"Theorem by theorem", "premises"} <= set(rows["arms.all.m2.json"])
    assert any(
        rule.startswith("BoundEveryN") or rule.startswith("ForAll") for rule in rows["arms.all.m2.json"]
    )
    trusted = data["trusted"]["proved"]
    assert set(trusted["rules"]) == {rule for rules in rows.values() for rule in rules}
    total = sum(trusted["modules"].values())
    assert text.count(f"{total:>5} lines in {len(trusted['modules'])} modules") >= 1
    assert "trusted for all that is proved" in text


def test_what_a_headline_takes_for_granted_stands_with_it(shown):
    text, data = shown
    rows = {row["file"]: row for row in data["certificates"]}
    granted = rows["arms.all.m2.json"]["granted"]
    assert granted
    assert all(f"  {sentence}\n" in text for sentence in (*granted, *data["granted"]))
    assert all(not row["granted"] for row in rows.values() if "Theorem by theorem" not in row["rules"])


if __name__ == "__main__":
    GOLDEN.write_text(listed(), encoding="utf-8")
