"""Write the arena from folders of certificates: python -m tests.arena.plant FOLDER…

Good ones are taken as they are, the smallest of every kind and rule. Bad ones are made from good ones by
a change after which the statement is false, undefined or about another arm, or the proof no longer one;
digests are renewed, as whoever means harm would do. What is expected follows from the change, never from a
checker. Files ``bad/removed.*`` are certificates of kinds and rules that were removed: nothing writes them
today, so they are kept as they are.

To rebuild everything, write the certificates of the shipped scripts and of ``extra`` into folders, of which
the names begin the names of the files:

    lyapcheck check proofs/examples/arctan.py --certificates OUT/arc
    lyapcheck check proofs/asymptotics.py --certificates OUT/asy
    lyapcheck check proofs/every_m.py --certificates OUT/eve
    lyapcheck check proofs/published.py --m 1 --certificates OUT/pub
    lyapcheck robot buap3 --certificates OUT/rob
    lyapcheck check proofs/scalar.py --m 1 --certificates OUT/sca
    lyapcheck check proofs/tracking.py --m 1 --certificates OUT/tra
    python -m tests.arena.extra OUT/ext
    python -m tests.arena.plant OUT/arc OUT/asy OUT/eve OUT/pub OUT/rob OUT/sca OUT/tra OUT/ext
    python -m tests.arena.library OUT/lib, and so on: see there
    python -m tests.arena.truths
"""

from __future__ import annotations

import copy
import json
import shutil
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any

from tests.arena.attacks import attacks, encoded, sealed
from tests.arena.wrong import BROKEN, FALSE, TRUE, put

ARENA = Path(__file__).parent
MAX_BYTES = 12_000
MAX_PREMISE = 30_000
OF_EACH = 4
BAD_OF_EACH = 2
KEPT = ("ext.linked",)
"""The only good one with bounds along the links, which is not among the smallest of its kind."""
REFUSED, NOT_ACCEPTED = ["refused"], ["refused", "undecided"]
NO_VALUE = ["div", ["num", "1"], ["num", "0"]]
NO_BOUND: dict[str, tuple[str, Any]] = {
    "MassBelow": ("high", "-1"),
    "CoriolisBelow": ("high", "-1"),
    "ChainCoriolisBelow": ("high", "-1"),
    "GravityBelow": ("high", "-1"),
    "MassAbove": ("low", "1000000007"),
    "NormBound": ("bound", ["num", "-1"]),
    "Decreasing": ("kv", ["-1", "-1", "-1"]),
}

Document = dict[str, Any]


def kind_of(document: Document) -> tuple[str, str, str]:
    return document["statement"]["kind"], document["verdict"], document["proof"]["rule"]


def relations(statement: Document) -> Iterator[Document]:
    """What a statement asserts: an object with ``left`` and ``right``, no hypothesis."""
    if "relation" in statement:
        yield statement["relation"]
    elif "conclusion" in statement:
        yield statement["conclusion"]
    elif "left" in statement and "right" in statement:
        yield statement


def false_statement(document: Document) -> bool:
    """Make a proved statement false for sure; False if this one cannot be."""
    statement = document["statement"]
    kind = statement["kind"]
    if document["verdict"] != "proved":
        return False
    if kind in ("Identity", "EveryN"):
        if statement["left"][0] in ("vec", "sum", "scale", "apply"):
            return False
        statement["right"] = ["add", statement["right"], ["num", "1"]]
    elif kind == "Agrees":
        statement["printed"] = statement["printed"] + "7"
    elif kind in NO_BOUND:
        name, value = NO_BOUND[kind]
        statement[name] = value
    elif kind == "TrigonometricBound":
        statement["entries"] = [[left, "-1"] for left, _ in statement["entries"]]
    elif kind == "BoundEveryN":
        statement["left"] = ["add", statement["right"], ["num", "1"]]
    elif kind in ("Constant", "ForAll"):
        relation = statement["relation"]
        strict = relation["operator"] == "<"
        relation["left"], relation["right"] = relation["right"], relation["left"]
        if not strict:
            relation["right"] = ["add", relation["right"], ["num", "-1"]]
    elif kind in FALSE:
        return FALSE[kind](statement)
    elif kind == "AllOf":
        parts = [{"verdict": "proved", "statement": part} for _, part in statement["parts"]]
        return any(false_statement(part) for part in parts)
    else:
        return False
    return True


def undefined(document: Document) -> bool:
    """Put a quotient by zero into each side."""
    result = list(relations(document["statement"]))
    for relation in result:
        for side in ("left", "right"):
            if relation[side][0] in ("vec", "sum", "scale", "apply"):
                return False
            relation[side] = ["add", relation[side], ["mul", ["num", "0"], NO_VALUE]]
    if document["statement"]["kind"] == "NormBound":
        document["statement"]["bound"] = NO_VALUE
        return True
    return bool(result)


def true_statement(document: Document) -> bool:
    """Make a refuted statement true, or another one than the proof is against."""
    change = TRUE.get((document["statement"]["kind"], document["proof"]["rule"]))
    return document["verdict"] == "refuted" and change is not None and change(document["statement"])


def opposite(document: Document) -> bool:
    """The same proof for the opposite verdict."""
    document["verdict"] = {"proved": "refuted", "refuted": "proved"}[document["verdict"]]
    return True


def other_rule(document: Document) -> bool:
    """A rule that no kind has."""
    document["proof"] = {**document["proof"], "rule": "as is well known"}
    return True


def no_proof(document: Document) -> bool:
    document["proof"] = {}
    return True


def more_data(document: Document) -> bool:
    """A field that the statement does not have."""
    document["statement"]["also"] = "1"
    return True


def other_kind(document: Document) -> bool:
    document["statement"]["kind"] = "Obvious"
    return True


def other_arm(document: Document) -> bool:
    """A far heavier arm under the bounds of the first; M negative where it must be positive."""
    statement = document["statement"]
    factor = {"MassBelow": 10**9, "CoriolisBelow": 10**9, "MassAbove": -1, "Decreasing": -1}.get(
        statement["kind"]
    )
    if factor is None or "mass" not in statement or document["verdict"] != "proved":
        return False
    for row in statement["mass"]:
        for entry in row:
            for term in entry:
                numerator, _, denominator = term[1].partition("/")
                term[1] = f"{int(numerator) * factor}" + (f"/{denominator}" if denominator else "")
    return bool(statement["mass"])


def other_words(document: Document) -> bool:
    """Another id under the digest of the first: see ``stale``."""
    document["claim"]["says"] = "the arm is globally exponentially stable for all gains"
    return True


CHANGES: dict[str, tuple[Callable[[Document], bool], list[str], str]] = {
    "false": (false_statement, REFUSED, "the statement is false"),
    "true": (true_statement, REFUSED, "what the proof is against is not stated"),
    "undefined": (undefined, REFUSED, "a term of the statement has no value"),
    "opposite": (opposite, REFUSED, "a proof of the opposite verdict"),
    "rule": (other_rule, REFUSED, "no rule has this name"),
    "no-proof": (no_proof, REFUSED, "there is no proof"),
    "field": (more_data, REFUSED, "the statement has no such field"),
    "kind": (other_kind, REFUSED, "no statement is of this kind"),
    "arm": (other_arm, REFUSED, "proved for another arm"),
}


def no_documents(sample: Document) -> Iterator[tuple[str, bytes, str]]:
    """Files that are no JSON of a certificate."""
    text = json.dumps(sample)
    yield "empty", b"", "an empty file"
    yield "not-json", b"proved, believe me\n", "not JSON"
    yield "cut", text[: len(text) // 2].encode(), "half a file"
    yield "twice", (text + text).encode(), "two documents in one file"
    yield "list", b"[" + text.encode() + b"]", "a list"
    yield "null", b"null", "null"
    yield "number", b"1", "a number"
    yield "latin", text.replace("claim", "cl\xe4im").encode("latin-1"), "not UTF-8"
    yield "utf16", text.encode("utf-16"), "not UTF-8"
    yield "zeros", b"\0" * 64, "not text"
    yield "brackets", b"[" * 100_000, "nested without end"
    yield "objects", b'{"a":' * 50_000 + b"1" + b"}" * 50_000, "nested without end"
    yield "duplicate", text.replace('"verdict"', '"verdict": "refuted", "verdict"', 1).encode(), "a key twice"
    yield "nan", text.replace('"grade"', '"x": NaN, "grade"', 1).encode(), "a number that JSON has not"
    yield (
        "infinity",
        text.replace('"grade"', '"x": Infinity, "grade"', 1).encode(),
        "a number that JSON has not",
    )
    yield "float", text.replace('"grade"', '"x": 0.5, "grade"', 1).encode(), "a float"
    yield "long", text.replace('"grade"', f'"x": {"9" * 5000}, "grade"', 1).encode(), "an endless integer"
    yield "digest", json.dumps({**sample, "digest": "0" * 64}).encode(), "the digest of something else"
    yield "no-digest", json.dumps({k: v for k, v in sample.items() if k != "digest"}).encode(), "no digest"
    yield (
        "capitals",
        json.dumps({**sample, "digest": sample["digest"].upper()}).encode(),
        "the digest in capitals",
    )


def no_certificates(sample: Document) -> Iterator[tuple[str, bytes, str]]:
    """JSON under its digest that is no certificate."""

    def changed(**values: Any) -> bytes:
        return json.dumps(sealed({**copy.deepcopy(sample), **values})).encode()

    yield "schema", changed(schema="lyapcheck/certificate/99"), "a schema of the future"
    for key in ("schema", "claim", "statement", "verdict", "grade", "proof", "uses", "versions"):
        without = {name: value for name, value in sample.items() if name != key}
        yield f"without-{key}", json.dumps(sealed(without)).encode(), f"no {key}"
        yield f"null-{key}", changed(**{key: None}), f"{key} is null"
    yield "more", changed(signature="trust me"), "a field that no certificate has"
    yield "verdict", changed(verdict="true"), "a verdict that there is not"
    yield "grade", changed(grade="certain"), "a grade that there is not"
    yield "grade-exact", changed(grade="exact"), "a better grade than the rule gives"
    yield "uses-list", changed(uses=["9"]), "uses is a list"
    yield "uses-digest", changed(uses={"9": "all of it"}), "uses names no digest"
    yield "statement-text", changed(statement="1 < 2"), "a statement in words"
    claim = sample["claim"]
    for name, value in [("m", 0), ("m", -1), ("m", "1"), ("m", True), ("n", 0), ("n", [3])]:
        yield (
            f"{name}-{value}".replace("[3]", "list"),
            changed(claim={**claim, name: value}),
            f"{name} is no count",
        )
    for name, value in [("id", ""), ("id", 7), ("says", None), ("proof", 7)]:
        yield f"claim-{name}-{value}", changed(claim={**claim, name: value}), f"{name} is no text"


def no_numbers(sample: Document) -> Iterator[tuple[str, bytes, str]]:
    """Certificates of inequalities between numbers, of terms that are none, have no value or no end."""

    def stated(left: Any, right: Any = ("num", "1"), operator: str = "<", bits: Any = 128) -> bytes:
        relation = {"left": left, "operator": operator, "right": right}
        statement = {"kind": "Constant", "relation": relation}
        proof = {"rule": "separate balls", "bits": bits}
        return json.dumps(sealed({**sample, "statement": statement, "proof": proof})).encode()

    nested: Any = ["num", "0"]
    for _ in range(400):
        nested = ["neg", nested]
    yield "node", stated(["believe", ["num", "0"]]), "an unknown node"
    yield "arity", stated(["sqrt", ["num", "4"], ["num", "0"]]), "a node with too many terms"
    yield "too-few", stated(["div", ["num", "1"]]), "a node with too few terms"
    yield "no-node", stated([]), "an empty node"
    yield "bare", stated("0"), "a term that is no node"
    yield "float-num", stated(["num", "0.1e-3"]), "a number that is no fraction"
    yield "num-zero", stated(["num", "1/0"]), "a fraction over zero"
    yield "num-int", stated(["num", 0]), "a number that is no text"
    yield "num-space", stated(["num", " 0"]), "a number with a space"
    yield "num-arabic", stated(["num", "\u0660"]), "a digit of another script"
    yield "num-under", stated(["num", "0_0"]), "a number with an underscore"
    yield "unknown-var", stated(["var", "x"]), "a number with a variable in it"
    yield "operator", stated(["num", "0"], operator="<<"), "an unknown relation"
    yield "deep-term", stated(nested), "nested too deeply"
    yield "power", stated(["pow", ["num", "10"], 10**18]), "a power that no machine holds"
    yield (
        "tower",
        stated(["pow", ["pow", ["pow", ["num", "9"], 999999], 999999], 999999]),
        "a tower of powers",
    )
    yield "negative-power", stated(["pow", ["num", "0"], -1]), "zero to a negative power"
    yield "root", stated(["sqrt", ["num", "-1"]]), "the root of a negative number"
    yield "log", stated(["log", ["num", "0"]]), "the logarithm of zero"
    yield "gamma-0", stated(["gamma", 0]), "γ of m = 0"
    yield "gamma-large", stated(["gamma", 10**15]), "γ of an m that no machine reaches"
    yield "bits-negative", stated(["num", "0"], bits=-1), "a negative precision"
    yield "bits-zero", stated(["num", "0"], bits=0), "no precision"
    yield "bits-endless", stated(["num", "0"], bits=10**18), "a precision that no machine has"
    yield "bits-true", stated(["num", "0"], bits=True), "a precision that is no number"
    yield "equal", stated(["num", "1"]), "1 < 1"
    yield (
        "near",
        stated(["num", "1" + "0" * 60], ["num", "1" + "0" * 59 + "1/1"]),
        "10⁶⁰ against a smaller number",
    )
    yield "less", stated(["num", "2"]), "2 < 1"
    yield "hidden-zero", stated(["div", ["num", "1"], ["add", ["num", "1"], ["num", "-1"]]]), "1/(1 − 1)"
    two = ["pow", ["sqrt", ["num", "2"]], 2]
    yield "hidden-root", stated(["sqrt", ["add", ["num", "-3"], two]]), "√(−3 + (√2)²)"
    yield "swallowed", stated(["mul", ["num", "0"], NO_VALUE]), "0 · (1/0)"
    yield "cancelled", stated(["add", NO_VALUE, ["neg", NO_VALUE]]), "1/0 − 1/0"


def read(folders: list[Path]) -> list[tuple[str, Document]]:
    """The certificates of the folders, smallest first, each with a name."""
    result = [
        (f"{folder.name}.{path.stem}", path) for folder in folders for path in sorted(folder.glob("*.json"))
    ]
    result = [(name, path) for name, path in result if path.stat().st_size <= MAX_PREMISE]
    result.sort(key=lambda item: (item[1].stat().st_size, item[0]))
    return [(name, json.loads(path.read_text())) for name, path in result]


class Arena:
    """The files written so far, and what is expected of each."""

    def __init__(self) -> None:
        self.entries: list[dict[str, Any]] = []
        removed = {path.name: path.read_bytes() for path in sorted((ARENA / "bad").glob("removed.*.json"))}
        for name in ("good", "bad"):
            shutil.rmtree(ARENA / name, ignore_errors=True)
            (ARENA / name).mkdir()
        for name, content in removed.items():
            why = f"{json.loads(content)['statement']['kind']}: lyapcheck 0.1.0 accepts it, no later version"
            self.add(f"bad/{name}", content, REFUSED, why)

    def add(self, path: str, content: bytes | list[tuple[str, bytes]], expected: list[str], why: str) -> None:
        target = ARENA / path
        if isinstance(content, bytes):
            target.write_bytes(content)
        else:
            target.mkdir()
            for name, data in content:
                (target / name).write_bytes(data)
        self.entries.append({"path": path, "expected": expected, "why": why})


def with_premises(document: Document, by_digest: dict[str, Document]) -> list[Document] | None:
    """A certificate and all that it rests on; None if one is absent."""
    result, waiting = {}, [document]
    while waiting:
        one = waiting.pop()
        result[one["digest"]] = one
        for digest in one["uses"].values():
            if digest not in by_digest:
                return None
            waiting.append(by_digest[digest])
    return list(result.values())


def collections(arena: Arena, documents: list[tuple[str, Document]]) -> None:
    """Certificates with what they rest on, and with one of those absent, changed or in another's place."""
    by_digest = {document["digest"]: document for _, document in documents}
    taken: dict[tuple[str, str, str], int] = defaultdict(int)
    for name, document in documents:
        whole = with_premises(document, by_digest)
        key = kind_of(document)
        theorem = key[0] in ("Stable", "StableArm")
        if not document["uses"] or whole is None or taken[key] >= (4 if theorem else 1):
            continue
        taken[key] += 1
        files = [(f"{index}.json", encoded(one)) for index, one in enumerate(whole)]
        arena.add(
            f"good/with-premises.{name}", files, ["accepted"], "a certificate with all that it rests on"
        )
        arena.add(f"bad/no-premises.{name}", files[:1], NOT_ACCEPTED, "all premises are absent")
        arena.add(f"bad/one-absent.{name}", files[:-1], NOT_ACCEPTED, "one premise is absent")
        words = copy.deepcopy(whole[-1])
        other_words(words)
        last = files[-1][0]
        arena.add(
            f"bad/stale.{name}",
            [*files[:-1], (last, encoded(words))],
            NOT_ACCEPTED,
            "a premise was changed after",
        )
        renewed = (last, encoded(sealed(words)))
        arena.add(f"bad/renamed.{name}", [*files[:-1], renewed], NOT_ACCEPTED, "a premise of another digest")


def main(folders: list[str]) -> None:
    documents = read([Path(folder) for folder in folders])
    arena = Arena()
    good: dict[tuple[str, str, str], list[tuple[str, Document]]] = defaultdict(list)
    for name, document in documents:
        small = len(encoded(document)) <= MAX_BYTES
        if small and not document["uses"]:
            known = good[kind_of(document)]
            known += [(name, document)] if len(known) < OF_EACH or name in KEPT else []
    for (kind, verdict, rule), result in sorted(good.items()):
        for name, document in result:
            arena.add(f"good/{name}.json", encoded(document), ["accepted"], f"{kind} {verdict} by {rule}")
        for change, (make, expected, why) in CHANGES.items():
            for name, document in result[: OF_EACH if change in ("false", "true", "arm") else BAD_OF_EACH]:
                changed = copy.deepcopy(document)
                if make(changed):
                    arena.add(
                        f"bad/{change}.{name}.json", encoded(sealed(changed)), expected, f"{kind}: {why}"
                    )
        name, document = result[0]
        for index, (path, value, why) in enumerate(BROKEN.get((kind, rule), [])):
            if put((changed := copy.deepcopy(document))["proof"], path, value):
                arena.add(
                    f"bad/proof-{index}.{name}.json", encoded(sealed(changed)), REFUSED, f"{kind}: {why}"
                )
        other_words(words := copy.deepcopy(document))
        arena.add(
            f"bad/words.{name}.json", encoded(words), REFUSED, f"{kind}: other words under the old digest"
        )
    collections(arena, documents)
    sample = next(
        document for result in [good["Constant", "proved", "separate balls"]] for _, document in result
    )
    for name, data, why in chain(no_documents(sample), no_certificates(sample), no_numbers(sample)):
        arena.add(f"bad/hostile.{name}.json", data, REFUSED, why)
    for name, data, expected, why in attacks(dict(documents)):
        arena.add(f"bad/attack.{name}", data, expected, why)
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")
    bad = sum(entry["path"].startswith("bad/") for entry in arena.entries)
    print(f"{len(arena.entries) - bad} good, {bad} bad")


if __name__ == "__main__":
    main(sys.argv[1:])
