"""Certificates of arms, loops and theorems whose numbers, sizes or letters were chosen to deceive.

Each is a certificate of the folders with values put at some places, under a renewed digest. Each statement is
false, says nothing, or is not what the proof is about.
"""

from __future__ import annotations

import copy
import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path as FilePath
from typing import Any

Document = dict[str, Any]
Path = tuple[str | int, ...]
Edits = list[tuple[Path, Any]]
Attack = tuple[str, str, Edits, str]

LARGE = "1000000007"
HUGE = "1" + "0" * 3999
TINY = "1/" + "1" + "0" * 3990 + "7"
NO_MASS: list[Any] = [[[]]]
MINUS_MASS = [[[[[0, 0], "-1"]]]]
SINGULAR = [[[[[0, 0, 0, 0], "1"]], [[[0, 0, 0, 0], "1"]]], [[[[0, 0, 0, 0], "1"]], [[[0, 0, 0, 0], "1"]]]]
S, P = "statement", "proof"


def at(place: str, *names: str | int) -> Path:
    return (place, *names)


NOT_A_NUMBER = [
    "NaN",
    "nan",
    "Infinity",
    "-Infinity",
    "1e3",
    "0x10",
    "1/0",
    "-0",
    "00",
    "2/2",
    "1/-2",
    "1.5",
    "",
]
ON_NUMBERS: list[Attack] = [
    *(
        (f"torque-{k}", "ext.resting", [(at(S, "torque", 0), text)], f"a torque of {text or 'nothing'}")
        for k, text in enumerate(NOT_A_NUMBER)
    ),
    ("torque-null", "ext.resting", [(at(S, "torque", 0), None)], "a torque that is null"),
    ("torque-true", "ext.resting", [(at(S, "torque", 0), True)], "a torque that is true"),
    ("torque-int", "ext.resting", [(at(S, "torque", 0), 2)], "a torque that is no text"),
]
ON_RESTING: list[Attack] = [
    ("rest-torque-negative", "ext.resting", [(at(S, "torque"), ["-2", "-5"])], "negative bounds of torques"),
    ("rest-torque-kp", "ext.resting", [(at(S, "torque", 0), "10"), (at(S, "errors", 0), HUGE)], "d = k_p"),
    (
        "rest-torque-peak",
        "ext.resting",
        [(at(S, "torque", 0), "11"), (at(S, "errors", 0), "1")],
        "d above k_p",
    ),
    ("rest-kp-zero", "ext.resting", [(at(S, "kp", 0), "0")], "no stiffness"),
    ("rest-kp-negative", "ext.resting", [(at(S, "kp", 0), "-10")], "a negative stiffness"),
    ("rest-kp-tiny", "ext.resting", [(at(S, "kp", 0), TINY)], "hardly a stiffness"),
    ("rest-swapped", "ext.resting", [(at(S, "kp"), ["5", "10"])], "the gains of the other joint"),
    ("rest-few-errors", "ext.resting", [(at(S, "errors"), ["3/5"])], "an error for one joint of two"),
    ("rest-nothing", "ext.resting", [(at(S, n), []) for n in ("kp", "torque", "errors")], "no joint"),
    ("rest-error-negative", "ext.resting", [(at(S, "errors", 0), "-3/5")], "a negative error"),
    ("rest-m-zero", "ext.resting", [(at(S, "m"), 0)], "no h_0 is known"),
    ("rest-m-negative", "ext.resting", [(at(S, "m"), -1)], "no h_−1 is known"),
    ("rest-m-null", "ext.resting", [(at(S, "m"), None)], "which h_m is not said"),
    ("rest-m-true", "ext.resting", [(at(S, "m"), True)], "an m that is no number"),
    ("rest-m-endless", "ext.resting", [(at(S, "m"), 10**18)], "an m that no machine reaches"),
    ("rest-family", "ext.resting", [(at(S, "family"), "sign")], "an unknown h"),
    ("rest-tanh-m", "ext.not-resting", [(at(S, "m"), 1)], "a member of tanh"),
    ("rest-steeper", "ext.resting", [(at(S, "m"), 9)], "the errors of another h"),
    ("rest-within", "ext.not-resting", [(at(P, "error"), "1/2")], "a rest at the bound itself"),
    ("rest-mirrored", "ext.not-resting", [(at(P, "error"), "-1")], "a rest on the other side"),
    ("rest-no-bound", "ext.not-resting", [(at(S, "errors", 0), None)], "an error that nothing bounds"),
    ("rest-not-held", "ext.not-resting", [(at(S, "torque", 0), "0")], "a rest without torque"),
]
ON_CORNERS: list[Attack] = [
    ("corners-mass", "ext.mass-at-corners", [(at(S, "parameters", 0), ["1/4", "1"])], "a lighter corner"),
    ("corners-mass-square", "ext.mass-at-corners", [(at(S, "mass", 0, 0, 0, 0), [0, 0, 2])], "M that bends"),
    ("corners-mass-none", "ext.mass-at-corners", [(at(P, "each"), [])], "no corner"),
]
KINDS_OF_LOOP = ("ext.boxes",)
ON_DECREASING: list[Attack] = [
    *(
        (f"loop-{name}-{base[4:]}", base, edits, why)
        for base in KINDS_OF_LOOP
        for name, edits, why in [
            ("no-mass", [(at(S, "mass"), NO_MASS)], "an arm without mass"),
            ("minus-mass", [(at(S, "mass"), MINUS_MASS)], "an arm of negative mass"),
            ("kp-zero", [(at(S, "kp", 0), "0")], "no stiffness"),
            ("kp-minus", [(at(S, "kp", 0), "-1")], "a negative stiffness"),
            ("kv-zero", [(at(S, "kv", 0), "0")], "no damping"),
            ("kv-minus", [(at(S, "kv", 0), "-1")], "negative damping"),
            ("friction-zero", [(at(S, "viscous", 0), ["0", "0"])], "no friction"),
            ("friction-minus", [(at(S, "viscous", 0), ["-1", "1"])], "friction that may drive"),
            ("friction-back", [(at(S, "viscous", 0), ["1", "1/2"])], "an empty range of friction"),
            ("friction-wide", [(at(S, "viscous", 0), ["0", "1"])], "friction that may vanish"),
            ("friction-none", [(at(S, "viscous"), [])], "friction of no joint"),
            ("friction-more", [(at(S, "viscous"), [["1", "1"]] * 2)], "friction of another joint"),
            ("eps0-zero", [(at(S, "eps0"), "0")], "ε₀ = 0"),
            ("eps0-minus", [(at(S, "eps0"), "-1/10")], "ε₀ below 0"),
            ("eps0-large", [(at(S, "eps0"), "4")], "K̃ = 0"),
            ("eps0-huge", [(at(S, "eps0"), HUGE)], "an ε₀ without end"),
            ("parameter-back", [(at(S, "parameters"), [["1", "0"]])], "an empty range of no parameter"),
            ("coupling", [(at(S, "coupling"), ["-1"])], "a negative weight"),
            ("coupling-zero", [(at(S, "coupling"), ["0"])], "y = w"),
            ("coupling-two", [(at(S, "coupling"), ["1", "1"])], "weights of two joints"),
            ("m", [(at(S, "m"), 2)], "a member of tanh"),
            ("m-zero", [(at(S, "family"), "hyperbolic"), (at(S, "m"), 0)], "no h_0 is known"),
            (
                "singular",
                [
                    (at(S, "mass"), SINGULAR),
                    (at(S, "viscous"), [["1", "1"]] * 2),
                    *((at(S, gain), ["1", "1"]) for gain in ("kp", "kv")),
                ],
                "a singular arm of two joints",
            ),
        ]
    ),
    ("corners-one", "ext.links-at-corners", [(at(P, "each"), [])], "no arm"),
    ("corners-wide", "ext.links-at-corners", [(at(S, "parameters", 0), ["1", "3"])], "a wider range"),
    (
        "corners-minus",
        "ext.links-at-corners",
        [(at(P, "each", 1, "links", 0, "mass"), "-2")],
        "a negative mass",
    ),
    ("linked-friction", "ext.linked", [(at(S, "viscous", 0), ["1", "6"])], "friction below the proof's"),
    ("linked-stiffness", "ext.linked", [(at(S, "kp"), ["1/4", "1/4"])], "too little stiffness"),
    ("linked-eps0", "ext.linked", [(at(S, "eps0"), "3")], "an ε₀ that is far too large"),
    ("linked-wide", "ext.linked", [(at(S, "parameters", 0), ["1", "9"])], "masses beyond the arms"),
    ("linked-U", "ext.linked", [(at(P, "rate", "inertia", "prices"), ["1", "1"])], "M(q) above U"),
    ("linked-U-minus", "ext.linked", [(at(P, "rate", "inertia", "prices", 1), "-1")], "a bound below 0"),
    ("linked-U-none", "ext.linked", [(at(P, "rate", "inertia", "forms"), [])], "no form behind a bound"),
    (
        "linked-Q",
        "ext.linked",
        [(at(P, "rate", side, 0, "prices"), ["0", "0"]) for side in ("rising", "falling")],
        "rates of M(q) above their bound",
    ),
    ("linked-Q-none", "ext.linked", [(at(P, "rate", "rising"), [])], "no bound of the rates"),
    ("linked-tree", "ext.linked", [(at(P, "rate", "tree"), ".")], "a tree without its boxes"),
    ("linked-scales", "ext.linked", [(at(P, "rate", "scales"), "")], "no scales"),
    ("linked-multiplier-small", "ext.linked", [(at(P, "rate", "scales"), "0LMUTNNNTS")], "l far too small"),
    ("linked-multiplier-large", "ext.linked", [(at(P, "rate", "scales"), "oLMUTNNNTS")], "l far too large"),
    ("linked-sizes", "ext.linked", [(at(P, "rate", "scales"), "N0o0oNNNTS")], "sizes of w and p far off"),
    ("linked-scales-long", "ext.linked", [(at(P, "rate", "scales"), "NLMUTNNNTSN")], "a scale too many"),
    ("linked-scale-none", "ext.linked", [(at(P, "rate", "scales"), "/LMUTNNNTS")], "a sign before the first"),
    ("linked-no-boxes", "ext.linked", [(at(P, "rate", k), "") for k in ("tree", "scales")], "no box at all"),
    (
        "linked-Q-minus",
        "ext.linked",
        [(at(P, "rate", k, 0, "prices", 0), "-1") for k in ("rising", "falling")],
        "Q < 0",
    ),
    (
        "loop-ranges-high",
        "ext.boxes",
        [(at(S, "viscous", 0), ["1", "100"])],
        "more friction than K_p pays for",
    ),
    (
        "linked-ranges-high",
        "ext.linked",
        [(at(S, "viscous", 0), ["5", "600"])],
        "more friction than K_p pays for",
    ),
    ("loop-ranges", "ext.boxes", [(at(S, "viscous", 0), ["1/1000000", "1000000"])], "far more arms"),
    ("state-origin", "ext.eps0-too-large", [(at(P, "w", 0), "0")], "the origin"),
    ("state-eps0", "ext.eps0-too-large", [(at(S, "eps0"), "1/10")], "an ε₀ at which V falls"),
    ("state-eps0-zero", "ext.eps0-too-large", [(at(S, "eps0"), "0")], "ε₀ = 0"),
    ("state-coupling", "ext.eps0-too-large", [(at(S, "coupling"), ["1"])], "a state of another V"),
    (
        "state-parameter",
        "ext.eps0-too-large",
        [(at(P, "parameters"), ["1"])],
        "a parameter that there is not",
    ),
    ("posture-mass", "ext.no-arm", [(at(S, "mass", 0, 0, 0, 1), "1")], "an arm of positive mass"),
    ("posture-zero", "ext.no-arm", [(at(P, "x", 0), "0")], "the vector 0"),
    ("damping-factor", "pub.19n.m1", [(at(P, "factor"), TINY)], "a factor at which the bound is kept"),
    ("damping-minus", "pub.19n.m1", [(at(S, "kv", 0), "-1")], "negative damping"),
    ("damping-bound", "pub.19n.m1", [(at(S, "bound"), ["num", HUGE])], "a bound far above"),
    ("damping-value", "pub.19n.m1", [(at(S, "bound"), ["div", ["num", "1"], ["num", "0"]])], "no bound"),
    ("damping-eps0", "pub.19n.m1", [(at(P, "eps0"), "-1")], "ε₀ below 0"),
    ("damping-friction", "pub.19n.m1", [(at(S, "viscous", 0), ["1", "0"])], "an empty range of friction"),
]
TWO: Path = at(S, "mass", 0, 1)
ON_ARMS: list[Attack] = [
    ("links-joints", "ext.links", [(at(P, "links", 1, "origin"), ["0", "1", "0"])], "links placed otherwise"),
    ("links-turn", "ext.links", [(at(P, "links", 1, "turn"), [["0"] * 3] * 3)], "a turn that is none"),
    ("links-axis", "ext.links", [(at(P, "links", 1, "axis"), ["1", "0", "0"])], "another axis"),
    ("links-long", "ext.links", [(at(P, "links", 1, "axis"), ["0", "0", "2"])], "an axis of length 2"),
    ("links-massless", "ext.links", [(at(P, "links", 1, "mass"), "0")], "a last link without mass"),
    ("links-low", "ext.links", [(at(S, "low"), TINY)], "a bound that energies do not give"),
    ("links-minus", "ext.links", [(at(S, "low"), "-1")], "a negative bound"),
    ("links-parameter", "ext.links", [(at(S, "parameters"), [["1", "0"]])], "an empty range"),
    ("links-singular", "ext.links", [(at(S, "mass"), SINGULAR)], "a singular arm"),
    ("mass-empty-range", "ext.mass-range", [(at(S, "parameters"), [["2", "1"]])], "an empty range"),
    ("mass-no-range", "ext.mass-range", [(at(S, "parameters"), [])], "a parameter without range"),
    ("mass-wide-range", "ext.mass-range", [(at(S, "parameters"), [["1", "3"]])], "a wider range"),
    ("mass-minus-range", "ext.mass-range", [(at(S, "parameters"), [["-9", "1"]])], "a range below 0"),
    ("mass-high-minus", "ext.mass-boxes", [(at(S, "high"), "-6")], "a negative bound"),
    ("mass-high-near", "ext.mass-boxes", [(at(S, "high"), "58284271/10000000")], "3 + 2√2 less 10⁻⁸"),
    ("mass-skew", "ext.mass-boxes", [(at(S, "mass", 0, 1), [])], "M that is not symmetric"),
    ("mass-ragged", "ext.mass-boxes", [(at(S, "mass", 0), [[]])], "rows that differ in length"),
    ("mass-exponent", "ext.mass-boxes", [(at(S, "mass", 1, 1, 0, 0), [0, 0, 0, -1])], "a negative exponent"),
    ("mass-exponent-large", "ext.mass-boxes", [(at(S, "mass", 1, 1, 0, 0, 3), 41)], "an exponent above 40"),
    (
        "mass-exponent-short",
        "ext.mass-boxes",
        [(at(S, "mass", 1, 1, 0, 0), [0, 0, 0])],
        "exponents of no arm",
    ),
    (
        "mass-exponent-true",
        "ext.mass-boxes",
        [(at(S, "mass", 1, 1, 0, 0, 3), True)],
        "an exponent that is true",
    ),
    ("mass-witness-out", "ext.mass-range-large", [(at(P, "parameters", 0), "5/2")], "out of its range"),
    ("mass-witness-zero", "ext.mass-range-large", [(at(P, "x", 0), "0")], "the vector 0"),
    (
        "mass-witness-range",
        "ext.mass-range-large",
        [(at(S, "parameters", 0, 1), "1")],
        "out of a smaller range",
    ),
    ("coriolis-minus", "ext.coriolis-range", [(at(S, "high"), "-1")], "a negative bound"),
    ("coriolis-empty", "ext.coriolis-range", [(at(S, "parameters"), [["2", "1"]])], "an empty range"),
    ("coriolis-zero", "ext.coriolis-range", [(at(S, "high"), "0")], "C that vanishes"),
    ("gravity-minus", "ext.gravity-boxes", [(at(S, "high"), "-3/2")], "a negative bound"),
    ("gravity-near", "ext.gravity-boxes", [(at(S, "high"), "2828427/2000000")], "√2 less 10⁻⁷"),
    (
        "gravity-twice",
        "ext.gravity-boxes",
        [(at(S, "gravity"), [[[[1, 0], "1"]], [[[1, 0], "1"]], [[[0, 1], "2"]]])],
        "three torques, each below the bound",
    ),
    ("gravity-joints", "ext.gravity-boxes", [(at(S, "joints"), 2)], "torques of another arm"),
    ("gravity-joints-zero", "ext.gravity-boxes", [(at(S, "joints"), 0)], "an arm without joints"),
    ("gravity-joints-many", "ext.gravity-boxes", [(at(S, "joints"), 10**18)], "joints without end"),
    ("gravity-witness", "ext.gravity-large", [(at(S, "high"), "3/2")], "a bound that is kept"),
    ("gravity-witness-far", "ext.gravity-large", [(at(P, "q", 0), "10" * 1900)], "a posture of no precision"),
    ("potential-none", "ext.potential", [(at(S, "gravity"), [])], "no torque"),
    ("potential-sign", "ext.potential", [(at(S, "potential", 0, 1), "1")], "the opposite potential"),
    ("potential-angle", "ext.potential", [(at(S, "gravity"), [[], [[[1, 0], "1"]]])], "of another joint"),
    ("symmetric-range", "ext.symmetric", [(at(S, "parameters"), [["1", "0"]])], "an empty range"),
    ("symmetric-none", "ext.symmetric", [(at(S, "mass"), [])], "no joint"),
    ("printed-row", "ext.symbols", [(at(S, "printed", 0), [])], "a row without entries"),
    ("printed-short", "ext.symbols", [(at(S, "printed", 0, 0), [[], []])], "an entry without its last part"),
    ("printed-one", "ext.symbols", [(at(S, "printed"), [[[[], [], []]]])], "C of one joint"),
    ("printed-swapped", "ext.symbols", [(at(S, "printed", 1, 0, 0, 0, 1), "-1")], "a sign changed"),
    ("printed-skew", "ext.RateOfMass.printed", [(TWO, [])], "M that is not symmetric"),
    ("printed-halves", "ext.RateOfMass.friction", [(at(S, "printed", 0, 0, 2), [])], "no friction after all"),
]
MIRROR = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "-1"]]
ON_CHAINS: list[Attack] = [
    ("chain-low", "ext.chain-lambda_min", [(at(S, "low"), "1")], "a bound above λmin(M) somewhere"),
    ("chain-low-minus", "ext.chain-lambda_min", [(at(S, "low"), "-1")], "a negative bound"),
    ("chain-high", "ext.chain-lambda_max", [(at(S, "high"), "14571/2500")], "3 + 2√2 less 3·10⁻⁵"),
    ("chain-high-none", "ext.chain-lambda_max", [(at(S, "high"), "0")], "no size"),
    ("chain-heavier", "ext.chain-lambda_max", [(at(S, "links", 1, "mass"), "2")], "a heavier last link"),
    ("chain-longer", "ext.chain-lambda_max", [(at(S, "links", 1, "com", 0), "3/2")], "a longer last link"),
    ("chain-farther", "ext.chain-lambda_max", [(at(S, "links", 1, "origin", 0), "2")], "a joint farther off"),
    ("chain-axis", "ext.chain-lambda_max", [(at(S, "links", 0, "axis"), ["0", "0", "1/2"])], "half an axis"),
    ("chain-mirror", "ext.chain-lambda_max", [(at(S, "links", 1, "turn"), MIRROR)], "a turn that mirrors"),
    ("chain-shrink", "ext.chain-lambda_max", [(at(S, "links", 1, "turn", 0, 0), "1/2")], "no rotation"),
    ("chain-minus", "ext.chain-lambda_max", [(at(S, "links", 1, "mass"), "-1")], "a negative mass"),
    ("chain-skew", "ext.chain-lambda_max", [(at(S, "links", 1, "inertia", 0, 1), "1")], "no inertia"),
    ("chain-digits", "ext.chain-lambda_max", [(at(S, "links", 1, "mass"), HUGE)], "a number without end"),
    ("chain-none", "ext.chain-lambda_max", [(at(S, "links"), [])], "no link"),
    ("chain-forms", "ext.chain-lambda_max", [(at(P, "forms"), [])], "no forms"),
    ("chain-forms-short", "ext.chain-lambda_max", [(at(P, "forms", 0), ["1"])], "too few coefficients"),
    ("chain-forms-zero", "ext.chain-lambda_max", [(at(P, "forms", 1), ["0"] * 7)], "forms that are 0"),
    ("chain-forms-large", "ext.chain-lambda_max", [(at(P, "forms", 1), [HUGE] * 7)], "forms without end"),
    ("chain-gravity", "ext.chain-k_g", [(at(S, "high"), "3")], "‖g‖ at rest at the side less 0.16"),
    ("chain-fall", "ext.chain-k_g", [(at(S, "fall"), ["2", "0", "0"])], "twice the free fall"),
    ("chain-fall-plane", "ext.chain-k_g", [(at(S, "fall"), ["1", "0"])], "a free fall of the plane"),
    ("chain-joints", "ext.chain-k_g2", [(at(S, "joints"), [1, 2])], "more joints"),
    ("chain-joint-other", "ext.chain-k_g2", [(at(S, "joints"), [1])], "another joint"),
    ("chain-joint-none", "ext.chain-k_g2", [(at(S, "joints"), [])], "no joint"),
    ("chain-joint-zero", "ext.chain-k_g2", [(at(S, "joints"), [0])], "a joint before the first"),
    ("chain-joint-twice", "ext.chain-k_g2", [(at(S, "joints"), [2, 2])], "a joint twice"),
    ("chain-joint-beyond", "ext.chain-k_g2", [(at(S, "joints"), [3])], "a joint that there is not"),
    ("chain-massless", "ext.chain-moments", [(at(S, "links", 1, "mass"), "0")], "a last link without mass"),
    ("chain-moments-low", "ext.chain-moments", [(at(S, "low"), TINY)], "a bound that moments do not give"),
    ("chain-torque-some", "ext.chain-no-torque", [(at(S, "fall"), ["1", "0", "0"])], "gravity in the plane"),
    ("chain-torque-minus", "ext.chain-no-torque", [(at(S, "high"), "-1")], "a negative bound"),
    ("chain-identity", "ext.chain-skew", [(at(S, "identity"), "M(q) = 0")], "no identity of the list"),
    ("chain-identity-none", "ext.chain-rate", [(at(S, "identity"), "")], "no identity"),
    ("chain-identity-axis", "ext.chain-rate", [(at(S, "links", 0, "axis"), ["0", "0", "2"])], "a long axis"),
    ("chain-identity-mirror", "ext.chain-symmetric", [(at(S, "links", 1, "turn"), MIRROR)], "a mirror"),
    ("chain-identity-rule", "ext.chain-at-rest", [(at(P, "rule"), "own moments")], "another rule"),
    ("chain-posture-zero", "ext.chain-small", [(at(P, "x"), ["0", "0"])], "the vector 0"),
    ("chain-posture-low", "ext.chain-small", [(at(S, "low"), "0")], "no state has xᵀMx < 0"),
    ("chain-posture-high", "ext.chain-large", [(at(S, "high"), "6")], "above 3 + 2√2"),
    ("chain-posture-more", "ext.chain-large", [(at(P, "parameters"), ["1"])], "a parameter that is none"),
    ("chain-posture-torque", "ext.chain-torque", [(at(S, "high"), "3")], "the largest g1"),
]
X: list[Any] = ["var", "x"]
LOOP_BASE = "ext.V-is-positive-definite"
UNBOUNDED = "ext.V-is-radially-unbounded"
SMOOTH = "ext.V-is-continuously-differentiable"
ONLY = "ext.the-origin-is-the-only-equilibrium"
SQUARE = ["pow", X, 2]
ARGUED: Path = (S, "argument")
MEMBER: Path = (*ARGUED, "system", "functions", 0, "member")
UNUSED = at(S, "argument", "rate", "entries", 0)
"""A coefficient that the property does not need: it must be one all the same."""
ON_PROPERTIES: list[Attack] = [
    *(
        (f"coefficient-{k}", "ext.V-is-positive-definite", [(UNUSED, tree)], "a coefficient that is none")
        for k, tree in enumerate(
            (["num", "0, whatever happens"], ["num", "1.5"], ["foo", ["num", "1"]], "1", ["var", ["pi"], 2])
        )
    ),
    ("property-unknown", LOOP_BASE, [(at(S, "name"), "V is radially bounded")], "an unknown property"),
    ("property-other", LOOP_BASE, [(at(S, "name"), "the origin is the only equilibrium")], "no form at rest"),
    ("property-decrescent", LOOP_BASE, [(at(S, "name"), "V is decrescent")], "no form above V"),
    (
        "property-desired",
        LOOP_BASE,
        [((*ARGUED, "system", "desired"), True)],
        "a theorem that is not for q_d(t)",
    ),
    (
        "property-constant",
        LOOP_BASE,
        [((*MEMBER, "potential"), ["add", ["potential", 1, X], ["num", "1"]])],
        "U(0) = 1",
    ),
    ("property-slope", LOOP_BASE, [((*MEMBER, "slope"), ["num", "0"])], "a slope that is not h'"),
    ("property-member", LOOP_BASE, [((*MEMBER, "potential"), ["potential", 2, X])], "U of another h"),
    (
        "property-below",
        LOOP_BASE,
        [((*ARGUED, "lower", "linear", 0, 1), ["var", "Kp_max"])],
        "φ that is above V",
    ),
    (
        "property-even",
        ONLY,
        [((*MEMBER, "value"), SQUARE), ((*MEMBER, "slope"), ["mul", ["num", "2"], X])],
        "h that is even",
    ),
    (
        "property-sine",
        ONLY,
        [((*MEMBER, "value"), ["sin", X]), ((*MEMBER, "slope"), ["cos", X])],
        "h = sin x",
    ),
    ("property-variable", ONLY, [((*MEMBER, "value"), ["h", 1, ["var", "y"]])], "h of another variable"),
    (
        "property-value",
        ONLY,
        [((*MEMBER, "slope"), ["add", ["dh", 1, X], ["div", ["num", "0"], X]])],
        "no value at 0",
    ),
    (
        "property-torque",
        ONLY,
        [((*ARGUED, "system", "torque"), ["sum", ["vec", "gd"], ["vec", "dg"]])],
        "a torque that holds the arm everywhere",
    ),
    (
        "property-rest-low",
        ONLY,
        [((*ARGUED, "rest", "form", "entries", 0), ["num", "0"])],
        "χ that is 0",
    ),
    ("property-abs", SMOOTH, [((*MEMBER, "potential"), ["abs", X])], "U = |x|"),
    ("unbounded-few", UNBOUNDED, [(at(P, "proofs"), [])], "no fact is proved"),
    ("unbounded-zero", UNBOUNDED, [((*MEMBER, "low"), "0")], "h ≥ 0 from some x on"),
    ("unbounded-minus", UNBOUNDED, [((*MEMBER, "low"), "-1")], "h ≥ −1 from some x on"),
    ("unbounded-start", UNBOUNDED, [((*MEMBER, "start"), "-1")], "from below 0 on"),
    ("unbounded-gamma", UNBOUNDED, [((*MEMBER, "gamma"), "1/2")], "h above γ"),
    ("smooth-rho", SMOOTH, [((*MEMBER, "rho"), "1/2")], "h' above ρ"),
    ("smooth-secant", SMOOTH, [((*MEMBER, "secant"), "1/2")], "h above L x"),
]
ON_SMALL: list[Attack] = [
    ("small-name", "ext.small", [(at(S, "small"), "x")], "one name for two variables"),
    ("small-bounded", "ext.small", [(at(S, "bounded"), ["eps"])], "ε bounded by 1"),
    ("small-free", "ext.small", [(at(S, "variables", 0, "low"), None)], "x that may be negative"),
    ("small-low", "ext.small", [(at(S, "variables", 0, "low"), "-1")], "x from −1 on"),
    ("small-closed", "ext.small", [(at(S, "variables", 0, "strict"), False)], "x that may be 0"),
    (
        "small-uniform",
        "ext.small",
        [(at(S, "bounded"), ["x"]), (at(S, "variables"), [])],
        "one threshold for all x",
    ),
    ("small-other", "ext.small", [(at(S, "small"), "y")], "ε that is not small"),
    ("small-shared-none", "ext.small-shared", [(at(S, "bounded"), [])], "t of no range"),
    ("small-below", "ext.not-small", [(at(P, "below"), HUGE), (at(S, "small"), "x")], "another variable"),
    ("small-point-zero", "ext.not-small", [(at(P, "point"), [["x", "0"]])], "x = 0, which is excluded"),
    ("small-point-twice", "ext.not-small", [(at(P, "point"), [["x", "1"], ["x", "1"]])], "a variable twice"),
    ("small-point-eps", "ext.not-small", [(at(P, "point"), [["x", "1"], ["eps", "1"]])], "a value of ε"),
    ("angles-none-of", "ext.positive", [(at(S, "entries", 0), X)], "no polynomial in sines"),
    ("angles-zero", "ext.positive", [(at(S, "entries", 0, 1, 1), "1")], "1 + sin x, which vanishes"),
    (
        "angles-near",
        "ext.positive",
        [(at(S, "entries", 0, 1, 1), "9" * 300 + "/1" + "0" * 300)],
        "near 1 + sin x",
    ),
    (
        "angles-value",
        "ext.not-positive",
        [
            (at(S, "entries"), [["div", ["num", "1"], ["num", "0"]], ["sin", X]]),
            (at(P, "entry"), 1),
            (at(P, "point"), [["x", "-1"]]),
        ],
        "another entry without value",
    ),
]
WHOLE: list[Attack] = [
    (one["name"], "ext.boxes", [((key,), one[key]) for key in (S, P, "verdict", "grade")], one["why"])
    for one in json.loads(FilePath(__file__).with_name("whole.json").read_text(encoding="utf-8"))
]
"""Statements and proofs that are put in place of those of a certificate as a whole."""
ON_SIZES: list[Attack] = [
    ("tree-words", "ext.boxes", [(at(P, "rate", "tree"), "believe me")], "words for a tree of boxes"),
    (
        "radius-endless",
        "ext.boxes",
        [(at(S, "kp", 0), HUGE), (at(S, "eps0"), HUGE[:3000])],
        "gains for which norms suffice beyond all angles only",
    ),
    (
        "harmonics-endless",
        "ext.gravity-boxes",
        [(at(S, "joints"), 9), (at(S, "gravity"), [[[[40] * 18, "1"]]])],
        "a term of 81⁹ exponentials",
    ),
]

SINGLE = [
    *ON_NUMBERS,
    *ON_RESTING,
    *ON_CORNERS,
    *ON_DECREASING,
    *ON_ARMS,
    *ON_CHAINS,
    *ON_PROPERTIES,
    *ON_SMALL,
    *ON_SIZES,
    *WHOLE,
]

FREE, ARM, TIME = "sca.arms.all.m1", "sca.arm.stable.m1", "tra.21.m1"
CONDITION, MOVING = "sca.arms.stable.m1", "tra.arm.21.m1"
ARGUMENT = at(S, "argument")
SYSTEM, MEMBER = (*ARGUMENT, "system"), (*ARGUMENT, "system", "functions", 0, "member")
TORQUE, MASS = (*SYSTEM, "torque"), at(S, "arm", "mass")
NEVER = {"left": ["num", "1"], "operator": "<", "right": ["num", "0"]}
ZERO = ["num", "0"]
ON_THEOREMS: list[Attack] = [
    ("theorem-name", FREE, [((*ARGUMENT, "theorem"), "Lyapunov's second thoughts")], "an unknown theorem"),
    ("theorem-ISS", FREE, [((*ARGUMENT, "theorem"), "ISS")], "of a loop without a disturbance"),
    ("theorem-exponential", TIME, [((*ARGUMENT, "theorem"), "exponential")], "V is not quadratic in ‖e‖"),
    ("theorem-time", TIME, [((*ARGUMENT, "theorem"), "strict")], "of a loop that depends on time"),
    ("theorem-no-upper", TIME, [((*ARGUMENT, "upper"), None)], "V ≤ Φ is not shown"),
    ("theorem-desired", FREE, [((*SYSTEM, "desired"), True)], "along a motion, by the theorem for a goal"),
    ("theorem-no-desired", TIME, [((*SYSTEM, "desired"), False)], "at a goal, under a torque for a motion"),
    ("theorem-disturbed", FREE, [((*SYSTEM, "disturbed"), True)], "under an unknown torque"),
    ("theorem-no-friction", FREE, [((*SYSTEM, "friction"), "none")], "dV/dt needs friction"),
    ("theorem-any-friction", FREE, [((*SYSTEM, "friction"), "any")], "friction that may vanish"),
    ("theorem-damping", FREE, [((*TORQUE, 1, 2, 1), ["num", "1"])], "K_v h(q̇) turned"),
    ("theorem-stiffness", FREE, [((*TORQUE, 1, 1, 1), ["diag", "Kv"])], "K_v in place of K_p"),
    ("theorem-repelling", FREE, [((*TORQUE, 1, 1, 2), ["scale", ["num", "-1"], ["vec", "h"]])], "K_p turned"),
    ("theorem-no-gravity", FREE, [((*TORQUE, 2), ["vec", "gd"])], "without g(q) − g(q_d)"),
    ("theorem-no-coriolis", TIME, [((*TORQUE, 1, 2, 1), ["mat", "D"])], "C(q, q̇_d) in place of C(q, q̇)"),
    ("theorem-no-inertia", TIME, [((*TORQUE, 1, 1, 2, 1), ["mat", "dM"])], "another M in (21)"),
    ("theorem-cross", FREE, [((*ARGUMENT, "energy", 1, 1, 1, 2, 1), ["num", "1"])], "one sign of V turned"),
    ("theorem-kinetic", FREE, [((*ARGUMENT, "energy", 2, 1), ["vec", "Kv"])], "V with K_v for K_p"),
    ("theorem-h", FREE, [((*MEMBER, "value"), ["h", 2, X])], "of another h"),
    ("theorem-slope", FREE, [((*MEMBER, "slope"), ["dh", 2, X])], "a slope that is not h'"),
    ("theorem-potential", FREE, [((*MEMBER, "potential"), ["potential", 2, X])], "U of another h"),
    ("theorem-gamma", FREE, [((*MEMBER, "gamma"), "1/2")], "γ below sup h"),
    ("theorem-gamma-none", FREE, [((*MEMBER, "gamma"), None)], "h said to be bounded by nothing"),
    ("theorem-rho", FREE, [((*MEMBER, "rho"), "1/2")], "ρ below sup |h'|"),
    ("theorem-rho-minus", FREE, [((*MEMBER, "rho"), "-1")], "ρ < 0"),
    ("theorem-secant", FREE, [((*MEMBER, "secant"), "1/2")], "L below sup h(x)/x"),
    ("theorem-low", FREE, [((*MEMBER, "low"), "2")], "h ≥ 2 from some x on"),
    ("theorem-start", FREE, [((*MEMBER, "start"), "-1")], "h ≥ 1/2 from −1 on"),
    ("theorem-linear", FREE, [((*MEMBER, "value"), X)], "h = x, which has no bound"),
    (
        "theorem-rate",
        FREE,
        [((*ARGUMENT, "rate", "entries"), [["num", "1"], ["num", "0"], ["num", "1"]])],
        "Θ = I",
    ),
    ("theorem-no-side", FREE, [((*ARGUMENT, "rate", "entries", 1), ZERO)], "Θ without θ12"),
    (
        "theorem-lower",
        FREE,
        [((*ARGUMENT, "lower", "entries", 0), ["var", "beta"])],
        "V above what it need not reach",
    ),
    ("theorem-not-small", FREE, [((*ARGUMENT, "small"), False)], "for every ε₀"),
    ("theorem-condition", FREE, [((*ARGUMENT, "where"), [NEVER])], "under a condition that nothing meets"),
    ("theorem-no-condition", CONDITION, [((*ARGUMENT, "where"), [])], "for all ε₀, the condition dropped"),
    (
        "theorem-half-condition",
        CONDITION,
        [((*ARGUMENT, "where", 0, "left", 1, 2), ["num", "8"])],
        "⅛ for ¼ in the condition",
    ),
    ("theorem-met", CONDITION, [(at(P, "met"), None)], "no constants that meet the condition"),
    ("theorem-proofs", FREE, [(at(P, "proofs"), [])], "no proof of any obligation"),
    ("theorem-no-numbers", ARM, [(at(S, "numbers"), [])], "an arm without numbers"),
    ("theorem-heavy", ARM, [((*MASS, 0, 0, 0, 1), LARGE)], "a heavier arm"),
    ("theorem-kp", ARM, [(at(S, "gains", 0, 1, 0), "1/1000")], "softer than the numbers say"),
    ("theorem-kp-minus", ARM, [(at(S, "gains", 0, 1, 0), "-60")], "a negative stiffness"),
    ("theorem-kv", ARM, [(at(S, "gains", 1, 1, 0), LARGE)], "more damping than the numbers say"),
    ("theorem-kv-zero", ARM, [(at(S, "gains", 1, 1, 0), "0")], "a joint without damping"),
    ("theorem-swapped", ARM, [(at(S, "gains", 0, 0), "Kv"), (at(S, "gains", 1, 0), "Kp")], "K_p for K_v"),
    ("theorem-friction", ARM, [(at(S, "arm", "viscous", 0), "0")], "a joint without friction"),
    ("theorem-few", ARM, [(at(S, "gains", 0), ["Kp", ["60"]])], "a gain for one joint"),
    ("theorem-no-joint", ARM, [(MASS, []), (at(S, "arm", "viscous"), [])], "no joint"),
    *(
        (f"theorem-{name}", base, [(at(S, "numbers", index), [name, value])], f"{name} = {value}")
        for base, index, name, value in (
            (ARM, 4, "beta", "1/30"),
            (ARM, 5, "eps0", "1"),
            (ARM, 6, "h_reach", "1"),
            (ARM, 7, "h_share", "1/2"),
            (ARM, 8, "h_slope", "1/2"),
            (ARM, 9, "k_secant", "1/2"),
            (ARM, 10, "kc", "1/100"),
            (MOVING, 11, "vd", "1000"),
        )
    ),
]


def sealed(document: Document) -> Document:
    """The document under the digest of its content."""
    content = {key: value for key, value in document.items() if key != "digest"}
    text = json.dumps(content, sort_keys=True, ensure_ascii=False, separators=(",", ":"))
    return {**content, "digest": hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()}


def encoded(document: Document) -> bytes:
    return (json.dumps(document, sort_keys=True, ensure_ascii=False) + "\n").encode()


def edited(document: Document, edits: Edits) -> Document:
    """A copy with values put at places, under its own digest."""
    changed = copy.deepcopy(document)
    for path, value in edits:
        place: Any = changed
        for step in path[:-1]:
            place = place[step]
        place[path[-1]] = value
    return sealed(changed)


def attacks(documents: Mapping[str, Document]) -> Iterator[tuple[str, bytes, list[str], str]]:
    """The name of each, its bytes or those of its files, what may come of it, and why."""
    for name, base, edits, why in [*SINGLE, *ON_THEOREMS]:
        yield f"{name}.json", encoded(edited(documents[base], edits)), ["refused"], why
