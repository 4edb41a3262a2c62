"""Changes by which a statement becomes false for sure, a refuted one true, or a proof none.

Each follows from what is changed by itself: no checker is asked.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Document = dict[str, Any]
ZERO = ["num", "0"]
MANY = 99


def _negated(tree: Any) -> Any:
    return ["neg", tree]


def _constant(statement: Document) -> Any:
    """The exponents of a term that is a number, in an arm."""
    joints = len(statement.get("mass") or statement["gravity"])
    return [0] * (2 * joints + len(statement["parameters"]))


def _resting(statement: Document) -> bool:
    """A torque holds each joint beside its goal, and no error is allowed."""
    statement["torque"] = ["1"] * len(statement["kp"])
    statement["errors"] = ["0"] * len(statement["kp"])
    return True


def _swapped(statement: Document) -> bool:
    relation = statement["conclusion"]
    relation["left"], relation["right"] = relation["right"], relation["left"]
    return not statement["hypotheses"] and relation["operator"] == "<"


def _not_positive(statement: Document) -> bool:
    statement["entries"] = [_negated(entry) for entry in statement["entries"]]
    return bool(statement["entries"])


def _no_force(statement: Document) -> bool:
    """h = U = 0: all postures are at rest, and V vanishes wherever nothing moves."""
    if statement["name"].endswith(("differentiable", "decrescent")):
        return False
    for function in statement["argument"]["system"]["functions"]:
        if statement["name"] == "the origin is an equilibrium":
            function["member"]["value"] = ["add", function["member"]["value"], ["num", "1"]]
        else:
            function["member"] |= dict.fromkeys(("value", "slope", "potential"), ZERO)
    return True


def _skewed(statement: Document) -> bool:
    """M12 is larger by 1 than M21."""
    if len(statement["mass"]) < 2:
        return False
    statement["mass"][0][1].append([_constant(statement), "1"])
    return True


def _friction(statement: Document) -> bool:
    """C11 has 1 more that no rate multiplies."""
    if not statement["printed"]:
        return False
    statement["printed"][0][0][-1].append([_constant(statement), "1"])
    return True


def _leaning(statement: Document) -> bool:
    """g1 has 1 more, and the potential is the same."""
    statement["gravity"][0].append([_constant(statement), "1"])
    return True


FALSE: dict[str, Callable[[Document], bool]] = {
    "Resting": _resting,
    "ForSmall": _swapped,
    "TrigonometricPositive": _not_positive,
    "Property": _no_force,
    "MassSymmetric": _skewed,
    "CoriolisAtRest": _friction,
    "RateOfMass": _friction,
    "RateLessTwiceCoriolis": _friction,
    "CoriolisTorque": _friction,
    "GravityOfPotential": _leaning,
}
"""A statement of each kind becomes false for sure; the answer is whether it does."""


def _bound(name: str, value: Any) -> Callable[[Document], bool]:
    def change(statement: Document) -> bool:
        statement[name] = value
        return True

    return change


def _same_sides(statement: Document) -> bool:
    relation = statement.get("relation") or statement.get("conclusion") or statement
    if "operator" in relation:
        relation["operator"] = "<="
    relation["right"] = relation["left"]
    return True


def _loose(statement: Document) -> bool:
    statement["entries"] = [[entry, "1000000007"] for entry, _ in statement["entries"]]
    return all(entry[0] in ("sin", "cos") for entry, _ in statement["entries"])


def _far_above(statement: Document) -> bool:
    statement["entries"] = [["add", ["num", "2"], ["sin", ["var", "x"]]] for _ in statement["entries"]]
    return True


def _unit_mass(statement: Document) -> bool:
    n = len(statement["mass"])
    one = [[_constant(statement), "1"]]
    statement["mass"] = [[one if i == j else [] for j in range(n)] for i in range(n)]
    return True


def _anything(statement: Document) -> bool:
    statement["errors"] = [None] * len(statement["errors"])
    return True


def _by_symbols(statement: Document) -> bool:
    statement["printed"] = []
    return True


def _still(statement: Document) -> bool:
    """Neither gravity nor a potential."""
    statement["gravity"], statement["potential"] = [[] for _ in statement["gravity"]], []
    return True


LARGE = "1000000007"
TRUE: dict[tuple[str, str], Callable[[Document], bool]] = {
    ("MassBelow", "posture"): _bound("high", LARGE),
    ("CoriolisBelow", "posture"): _bound("high", LARGE),
    ("ChainCoriolisBelow", "posture"): _bound("high", LARGE),
    ("GravityBelow", "posture"): _bound("high", LARGE),
    ("MassAbove", "posture"): _unit_mass,
    ("Decreasing", "posture"): _unit_mass,
    ("Resting", "state of rest"): _anything,
    ("TrigonometricBound", "witness of an entry"): _loose,
    ("TrigonometricPositive", "witness of an entry"): _far_above,
    ("ForSmall", "failure for small values"): _swapped,
    ("Implies", "witness"): _same_sides,
    ("ForAll", "witness"): _same_sides,
    ("Constant", "separate balls"): _same_sides,
    ("Constant", "exact numbers"): _same_sides,
    ("Identity", "witness"): _same_sides,
    ("EveryN", "entries"): _same_sides,
    ("MassSymmetric", "moving posture"): _unit_mass,
    ("CoriolisAtRest", "moving posture"): _by_symbols,
    ("RateOfMass", "moving posture"): _by_symbols,
    ("RateLessTwiceCoriolis", "moving posture"): _by_symbols,
    ("CoriolisTorque", "moving posture"): _by_symbols,
    ("GravityOfPotential", "moving posture"): _still,
}
"""Statements of these kinds, refuted by these rules, become true or no longer what the proof is against."""

Fault = tuple[tuple[str | int, ...], Any, str]
NO_POSTURE: list[Fault] = [
    (("q",), [], "a posture without joints"),
    (("parameters",), ["1"] * MANY, "a posture of another arm"),
]
NO_SHARES = "a share that is not between 0 and 1"
BROKEN: dict[tuple[str, str], list[Fault]] = {
    ("Agrees", "corners of the roundings"): [
        (("below",), [], "a corner of no inputs"),
        (("below", 0), 2, "an end that a range has not"),
    ],
    ("AllOf", "every part"): [(("parts",), [], "no part is proved")],
    ("AllOf", "one part"): [
        (("part",), -1, "a part counted from the end"),
        (("part",), MANY, "a part that there is not"),
    ],
    ("BoundEveryN", "covered terms"): [(("covers",), [], "no term is covered")],
    ("BoundEveryN", "entries"): [(("n",), 0, "entries of size 0"), (("n",), 7, "entries of another size")],
    ("EveryN", "entries"): [(("n",), 0, "entries of size 0"), (("point",), [], "entries without values")],
    ("Decreasing", "M positive and V decreasing"): [
        (("rate",), {"rule": "bisection"}, "no proof of dV/dt < 0"),
        (("inertia",), {"rule": "as is well known"}, "no proof of M ≻ 0"),
    ],
    ("Decreasing", "larger K_v"): [
        (("kv",), [], "no K_v for a joint"),
        (("kv",), ["1/4"], "a K_v that is smaller"),
        (("kv",), [LARGE], "a K_v for which there is no proof"),
        (("proof", "rate", "tree"), "", "no tree of boxes"),
        (("proof", "inertia"), {"rule": "as is well known"}, "no proof of M ≻ 0"),
        (
            ("proof",),
            {"rule": "state", "viscous": [], "parameters": [], "q": [], "e": [], "w": []},
            "a state",
        ),
    ],
    ("Decreasing", "state"): [
        (("w",), ["0"], "the origin"),
        (("w",), [], "a state without rates"),
        (("viscous",), [LARGE], "a friction out of its range"),
    ],
    ("ChainCoriolisBelow", "rates of M along the links"): [
        (("rates",), [], "no bound of a rate of M"),
        (("crossed",), [], "a joint without a share"),
        (("crossed",), ["0"], "a share of 0"),
        (("squared",), ["-1"], "a negative share"),
        (("squared",), [LARGE], "shares that show a larger bound"),
        (("rates", 0, "prices", 0), "0", "a bound of a rate that the forms do not show"),
        (("rates", 0, "prices"), [], "a bound of a rate without numbers"),
        (("rates", 0, "forms"), [], "no forms"),
    ],
    ("ChainCoriolisBelow", "posture"): [
        *NO_POSTURE,
        (("x",), ["0", "0"], "the vector 0"),
        (("x",), [], "no vector"),
        (("y",), ["1", "1"], "a second vector, which is not asked for"),
    ],
    ("DampingBelow", "damping above the bound"): [
        (("factor",), "-1", "a negative factor"),
        (("factor",), "0", "a factor of zero"),
        (("eps0",), "0", "no ε₀"),
    ],
    ("ForAll", "pieces of the domain"): [(("pieces",), [], "no piece")],
    ("ForSmall", "leading term"): [
        (
            ("identity", "multiples"),
            [{"hypothesis": 0, "weight": "1", "monomial": []}],
            "a hypothesis that there is not",
        ),
        (("identity", "lift"), [[0, -1]], "a negative power"),
        (("identity", "lift"), [[MANY, 1]], "a generator that there is not"),
    ],
    ("ForSmall", "failure for small values"): [
        (("below",), "0", "below zero, where ε is not"),
        (("point",), [["x", "-1"]], "a point out of the ranges"),
        (("point",), [], "no point"),
    ],
    ("Property", "obligations"): [(("proofs",), [], "no fact is proved")],
    ("MassAbove", "links"): [
        (("links",), [], "no link"),
        (("links", 0, "mass"), LARGE, "links of another mass"),
        (("links", 0, "mass"), "-1", "a link of negative mass"),
        (("links", 0, "axis"), ["0", "0", "0"], "a joint without axis"),
        (("links", 0, "axis"), ["0", "1"], "an axis of the plane"),
        (("links", 0, "inertia"), [["-1", "0", "0"], ["0"] * 3, ["0"] * 3], "a negative inertia"),
        (
            ("links", 0, "inertia"),
            [["1", "1", "0"], ["0"] * 3, ["0"] * 3],
            "an inertia that is not symmetric",
        ),
    ],
    ("NormBound", "supremum"): [(("numbers",), {"rule": "exact numbers"}, "a number that is not rational")],
    ("NormBound", "one entry"): [(("parts",), [], "no inequality is proved")],
    ("NormBound", "witness"): [(("point",), [], "no point")],
    ("Resting", "state of rest"): [
        (("joint",), -1, "a joint counted from the end"),
        (("joint",), MANY, "a joint that there is not"),
        (("error",), "0", "an error within its bound"),
        (("error",), LARGE, "a posture that the torque does not hold"),
    ],
    ("TrigonometricBound", "witness of an entry"): [(("entry",), -1, "an entry counted from the end")],
    ("TrigonometricPositive", "witness of an entry"): [
        (("entry",), -1, "an entry counted from the end"),
        (("lower",), False, "a bound from above, which there is not"),
    ],
    **{
        (kind, "posture"): [*NO_POSTURE, (("x",), ["0"] * n, "the vector 0") if n else NO_POSTURE[0]]
        for kind, n in (("MassAbove", 3), ("MassBelow", 3), ("CoriolisBelow", 3), ("GravityBelow", 0))
    },
    **{
        (kind, "moving posture"): [*NO_POSTURE, (("q",), ["1/0"], "a posture over zero")]
        for kind in (
            "MassSymmetric",
            "CoriolisAtRest",
            "RateOfMass",
            "RateLessTwiceCoriolis",
            "CoriolisTorque",
            "GravityOfPotential",
        )
    },
}
"""What is put at which place of a proof of a kind by a rule, after which it shows nothing."""


def put(document: Any, path: tuple[str | int, ...], value: Any) -> bool:
    """Put a value at a place; False if there is none."""
    for step in path[:-1]:
        try:
            document = document[step]
        except (KeyError, IndexError):
            return False
    if isinstance(document, list) and not -1 < int(path[-1]) < len(document):
        return False
    document[path[-1]] = value
    return True
