"""SARIF against the published schema of version 2.1.0 (the copy of schemastore.org, rtm.5)."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from tests.helpers.json_schema import faults

SCHEMA = json.loads(
    (Path(__file__).parents[1] / "schemas" / "sarif-2.1.0-rtm.5.json").read_text(encoding="utf-8")
)


def log(path: Path, **options: Any) -> dict[str, Any]:
    result: dict[str, Any] = json.loads(gate(read_gain_file(path), **options).written("sarif"))
    return result


def complaints(document: dict[str, Any]) -> list[str]:
    return list(faults(document, SCHEMA, SCHEMA))


@pytest.mark.parametrize(
    "options", [{}, {"deciding": ("10",)}, {"robot": "buap3-small"}, {"deciding": ("19",), "strict": True}]
)
@pytest.mark.parametrize("name", ["table2", "table2_pd"])
def test_a_log_follows_the_schema(name: str, options: dict[str, Any]) -> None:
    assert complaints(log(paper_gain_file(name), **options)) == []


def test_a_log_of_nasty_names_follows_the_schema(tmp_path: Path) -> None:
    path = tmp_path / "a b#?:\u00fc.toml"
    path.write_text(
        "robot = 'pelican2'\n[[gains]]\nname = '<b>\"%\\n λ'\nm = 2\nkp = [1, 1]\nkv = [1, 0.001]\n",
        encoding="utf-8",
    )
    outcome = log(path)
    assert complaints(outcome) == []
    levels = [result["level"] for result in outcome["runs"][0]["results"] if result["level"] != "note"]
    assert levels == ["error"]
    strict = log(path, strict=True)
    levels = [result["level"] for result in strict["runs"][0]["results"] if result["level"] != "note"]
    assert levels == ["error"]


@pytest.mark.parametrize(
    ("spoil", "complaint"),
    [
        (lambda run: run["tool"].pop("driver"), "lacks driver"),
        (lambda run: run["results"][0].update(level="fatal"), "is none of"),
        (lambda run: run["results"][0].update(lines=3), "unknown key lines"),
        (lambda run: run["results"][0]["message"].update(text=7), "is not of type string"),
        (lambda run: run["results"][0].update(partialFingerprints={"case/v1": 1}), "is not of type string"),
        (lambda run: run["results"][0].update(ruleIndex=-2), "is below -1"),
        (lambda run: run["results"][0]["message"].pop("text"), "fits none of"),
        (
            lambda run: run["results"][0]["locations"][0]["physicalLocation"]["region"].update(startLine=0),
            "is below 1",
        ),
    ],
)
def test_the_schema_refuses_other_logs(spoil: Callable[[Any], object], complaint: str) -> None:
    document = log(paper_gain_file())
    spoil(document["runs"][0])
    (result,) = complaints(document)
    assert complaint in result


def test_a_fingerprint_tells_gains_apart_and_nothing_else(tmp_path: Path) -> None:
    """The same set keeps it when its line or gains change; another set has its own."""

    def prints(**options: Any) -> list[str]:
        results = log(path, **options)["runs"][0]["results"]
        return [result["partialFingerprints"]["case/v1"] for result in results if result["level"] != "note"]

    path = tmp_path / "g.toml"
    text = paper_gain_file().read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    outcome = prints()
    path.write_text("# moved\n" + text.replace("0.223", "0.229"), encoding="utf-8")
    assert prints() == outcome
    both = prints(deciding=("10", "10p", "19"), robot="buap3-small")
    assert len(set(both)) == len(both) == 3
    assert set(outcome) < set(both)
