"""Documents held against the JSON Schemas of ``tests/schemas``."""

import json
from functools import cache
from pathlib import Path

import fastjsonschema

SCHEMAS = Path(__file__).parents[1] / "schemas"


@cache
def _checker(name):
    return fastjsonschema.compile(json.loads((SCHEMAS / f"{name}.json").read_text(encoding="utf-8")))


def follows(value, name):
    """Raise ``fastjsonschema.JsonSchemaException`` where a value breaks the schema of this name."""
    _checker(name)(value)
