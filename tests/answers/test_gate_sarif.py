"""SARIF against the published schema of version 2.1.0 (the copy of schemastore.org, rtm.5)."""

import json

import pytest
from fastjsonschema import JsonSchemaException

from lyapcheck.answers.gate import gate
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from tests.helpers.json_schema import follows

SARIF = "sarif-2.1.0-rtm.5"


def log(path, **options):
    result = json.loads(gate(read_gain_file(path), **options).written("sarif"))
    return result


@pytest.mark.parametrize(
    "options", [{}, {"deciding": ("10",)}, {"robot": "buap3-small"}, {"deciding": ("19",), "strict": True}]
)
@pytest.mark.parametrize("name", ["table2", "table2_pd"])
def test_a_log_follows_the_schema(name, options):
    follows(log(paper_gain_file(name), **options), SARIF)


def test_a_log_of_nasty_names_follows_the_schema(tmp_path):
    path = tmp_path / "a b#?:\u00fc.toml"
    path.write_text(
        "robot = 'pelican2'\n[[gains]]\nname = '<b>\"%\\n λ'\nm = 2\nkp = [1, 1]\nkv = [1, 0.001]\n",
        encoding="utf-8",
    )
    outcome = log(path)
    follows(outcome, SARIF)
    levels = [result["level"] for result in outcome["runs"][0]["results"] if result["level"] != "note"]
    assert levels == ["error"]
    strict = log(path, strict=True)
    levels = [result["level"] for result in strict["runs"][0]["results"] if result["level"] != "note"]
    assert levels == ["error"]


def test_the_schema_refuses_another_log():
    document = log(paper_gain_file())
    document["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"]["startLine"] = 0
    with pytest.raises(JsonSchemaException):
        follows(document, SARIF)


def test_a_fingerprint_tells_gains_apart_and_nothing_else(tmp_path):
    """The same set keeps it when its line or gains change; another set has its own."""

    def prints(**options):
        results = log(path, **options)["runs"][0]["results"]
        return [result["partialFingerprints"]["case/v1"] for result in results if result["level"] != "note"]

    path = tmp_path / "g.toml"
    text = paper_gain_file().read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    outcome = prints()
    path.write_text("# moved\n" + text.replace("0.223", "0.229"), encoding="utf-8")
    assert prints() == outcome
    path.write_text(text.replace("tau_m2", "other"), encoding="utf-8")
    assert [*map(outcome.__contains__, prints())] == [False, True]
    path.write_text(text, encoding="utf-8")
    both = prints(deciding=("10", "10p", "19"), robot="buap3-small")
    assert len(set(both)) == len(both) == 3
    assert set(outcome) < set(both)
