"""Changes of good certificates of the arena, each with words of the reason why it is then refused."""

import json
from collections.abc import Callable

from tests.arena.attacks import Document, Edits
from tests.arena.run import ARENA

S, P = "statement", "proof"
ARGUMENT = (S, "argument")
SYSTEM = (*ARGUMENT, "system")
FREE, MOVING = "with-premises.sca.arms.all.m1", "with-premises.tra.21.m1"
LASALLE, ARM = "with-premises.lib.P", "with-premises.lib.P.pelican"
EXPONENTIAL, CASCADE = "with-premises.slo.P", "with-premises.slo.convergence"
ISS = "with-premises.slo.P.disturbed"
ZERO, ONE, TWO, X = ["num", "0"], ["num", "1"], ["num", "2"], ["var", "x"]
SQUARE = ["pow", X, 2]
Changed = Callable[[Document], Edits]

Z_A_Y = ["dot", ["vec", "z"], ["apply", ["mat", "A"], ["vec", "y"]]]
Y_A_Z = ["dot", ["vec", "y"], ["apply", ["mat", "A"], ["vec", "z"]]]


SATURATED, BROKEN = "gate-the-limit-of-a-motor.tru", "gate-the-friction-of-the-gate.tru"
GATE = [
    ("joints", 0, "must be from 1"),
    ("kp", ["1", "1"], "one a joint"),
    ("kv", ["0"], "must be positive"),
    ("k_g", ["-1"], "must not be negative"),
    ("viscous", [["3", "2"]], "must be ranges from 0 on"),
    ("conditions", ["19", "10"], "must be some, in order"),
    ("limits", ["-1"], "must not be negative"),
    ("limits", [None], "must be known where a condition needs them"),
    ("gravity", [], "must be empty without gravity"),
    ("gravity", [[], []], "one a joint"),
    ("stability", [{"kind": "AllOf", "parts": []}], "is not about this arm and loop"),
]
AT_STATES = [
    ("joint", 1, "must be from 0 to 0"),
    ("x", "1000000001", "must be from −"),
    ("x", "0", "is not shown to exceed"),
]


def base(name):
    """A good certificate of the arena; of one with premises the first."""
    path = ARENA / "good" / f"{name}.json"
    document = json.loads((path if path.exists() else ARENA / "good" / name / "0.json").read_text())
    return document


def nested(operation, inner, *before, times=301):
    """An operation on itself."""
    for _ in range(times):
        inner = [operation, *before, inner]
    return inner


def powers(times):
    """((x⁴⁰)⁴⁰)…"""
    tree = X
    for _ in range(times):
        tree = ["pow", tree, 40]
    return tree


def with_parameters(mass, joints, count):
    """M(q) as a polynomial in so many parameters too."""
    return [[[[[*p[: 2 * joints], *[0] * count], c] for p, c in entry] for entry in row] for row in mass]


def one_link(document):
    return [((S, "links"), document[S]["links"][:1])]


def massless(document):
    link = {**document[P]["links"][0], "mass": "0"}
    return [((S, "mass"), [[[]]]), ((P, "links"), [link])]


def one_parameter(document):
    return [((S, "parameters"), [["1", "1"]]), ((S, "mass"), with_parameters(document[S]["mass"], 2, 1))]


def many_parameters(document):
    mass = document[S]["mass"]
    return [
        ((S, "parameters"), [["1", "1"]] * 17),
        ((S, "mass"), with_parameters(mass, len(mass), 17)),
    ]


def below_zero(document):
    sides = [["mul", ["var", "s"], side] for side in (Z_A_Y, Y_A_Z)]
    point = [*document[P]["point"], ["s", "-1"]]
    names = ((S, "left"), (S, "right"), (S, "positive"), (P, "point"))
    return list(zip(names, (*sides, ["s"], point), strict=True))


def changed_twice(document):
    return [((*ARGUMENT, "changes"), document[S]["argument"]["changes"] * 2)]


def function_of_changed(document):
    """U of a function of the controller's state, which is changed to y_x."""
    argument = document[S]["argument"]
    return [
        ((*SYSTEM, "states"), [{"name": "xc", "rate": ["vec", "e"]}]),
        ((*SYSTEM, "functions", 1, "of"), "xc"),
        ((*ARGUMENT, "changes"), [*argument["changes"], {"state": "xc", "equals": ["vec", "y_xc"]}]),
        ((*ARGUMENT, "energy"), ["add", argument["energy"], ["dot", ["vec", "Kp"], ["vec", "Uk"]]]),
    ]


def function_in_change(document):
    """w = Λe − y_w + diag(f(e)) e, which is not linear."""
    changes = document[S]["argument"]["changes"][0]["equals"]
    function = {"bounded": False, "member": None, "name": "f", "of": "e"}
    more = ["apply", ["diag", "f"], ["vec", "e"]]
    return [
        ((*SYSTEM, "functions"), [function]),
        ((*ARGUMENT, "changes", 0, "equals"), [*changes, more]),
    ]


def diagonal_of_changed(document):
    """wᵀ diag(w) w in V, with w changed to another letter."""
    cubic = ["dot", ["vec", "w"], ["apply", ["diag", "w"], ["vec", "w"]]]
    return [((*ARGUMENT, "energy"), ["add", document[S]["argument"]["energy"], cubic])]


def one_point(document):
    """1 ≤ x² at x = 1 alone, by a piece of one cut."""
    piece = {"bits": 64, "cuts": ["1"], "from_zero": False, "to_infinity": False, "rule": "Taylor boxes"}
    sides = {"left": ["pow", X, 2], "operator": "<=", "right": ONE}
    return [((S, "low"), "1"), ((S, "high"), "1"), ((S, "relation"), sides), ((P, "pieces"), [piece])]


def piece(cuts, from_zero=False):
    return {"bits": 64, "cuts": cuts, "from_zero": from_zero, "to_infinity": False, "rule": "Taylor boxes"}


def one_piece(left, operator, right, low, high, by):
    """A relation for all x from low to high, by one piece."""
    sides = {"left": left, "operator": operator, "right": right}
    return [((S, "relation"), sides), ((S, "low"), low), ((S, "high"), high), ((P, "pieces"), [by])]


def property_of(name, says):
    """A property of the loop and the V of another theorem."""

    def change(document):
        argument = base(name)[S]["argument"]
        return [((S,), {"kind": "Property", "name": says, "argument": argument}), ((P, "proofs"), [])]

    return change


def one_change_more(state):
    def change(document):
        changes = document[S]["argument"]["changes"]
        return [((*ARGUMENT, "changes"), [*changes, {"state": state, "equals": ["vec", f"y_{state}"]}])]

    return change


def state_changed_too(document):
    states = [{"name": "xc", "rate": ["vec", "e"]}]
    return [((*SYSTEM, "states"), states), *one_change_more("xc")(document)]


NO_PARAMETERS = [
    ((S, "parameters"), []),
    ((S, "mass", 0, 0, 0, 0), [0, 0]),
    ((P, "each"), [{"rule": "bisection"}]),
]
WAVE = ["mul", ["sin", ["div", ONE, ["var", "eps"]]], ["var", "eps"]]
REST = {"against": ["vec", "e"], "form": {"entries": [ONE], "linear": [], "sizes": ["norm_e"]}}
SMALL = {"left": ["var", "eps0"], "operator": "<", "right": ONE}
FIVE = ["norm_e", "norm_w", "norm_h", "norm_y_w", "norm_k"]
NO_BOUND = {"forms": [], "prices": []}
LINKED = {
    "rule": "bounds along the links",
    "arms": [],
    "inertia": NO_BOUND,
    "rising": [],
    "falling": [],
    "tree": "",
    "scales": "",
}
CASES = [
    ("ext.square", [(("versions",), {"a\u202e": "1"})], "is not plain Unicode text"),
    ("ext.square", [((S, "kind"), 7)], "must be text"),
    ("ext.square", [((S, "relation", "left"), {"num": "1"})], "is not part of an expression"),
    ("ext.square", [((S, "relation", "left"), nested("neg", ONE))], "is nested deeper than 300 levels"),
    ("ext.square", [((S, "relation", "left"), powers(4))], "parts with its powers written out"),
    ("ext.square", [((S, "variable"), "sin")], "is not a name of Latin or Greek letters"),
    ("ext.square", one_point, "the sign is open"),
    ("pub.F.10.base", [((S, "inputs"), [[f"k{c}", "1"] for c in "abcdefghijklmnopq"])], "must be at most 16"),
    ("pub.F.10.base", [((S, "inputs", 0, 1), "0x10")], "is not a decimal"),
    ("pub.2.8", [((S, "entries", 0), [["var", "q1"], None])], "must be a polynomial in sines and cosines"),
    ("asy.A.slope.m1", [((S, "variables"), [{"low": None, "name": "x", "strict": True}])], "does not occur"),
    ("ext.small", [((S, "conclusion", "right"), ["add", X, ["sin", ["var", "eps"]]])], "has functions in it"),
    (
        "ext.not-small",
        [((S, "conclusion", "left"), ["num", "0"]), ((S, "conclusion", "right"), WAVE)],
        "has no certain sign for small values",
    ),
    ("ext.equal-entries", [((S, "n"), 0)], "must be from 1 to"),
    ("ext.equal-entries", [((S, "power"), 2)], "must be 0 or 1"),
    # every n
    ("ext.norms", [((S, "left"), ["dot", ["vec", "z"], []])], "is not an operation with its parts"),
    ("ext.norms", [((S, "left", 1), ["vec", "n"])], "is the dimension"),
    ("ext.norms", [((S, "norms", 0, 0), [])], "bounds no letter"),
    ("ext.norms", [((S, "norms", 0, 0, 0), ["transpose", ["mat", "A"]])], "is not a letter"),
    (
        "ext.norms",
        [((S, "rates"), [[["mat", "A"], ["mat", "B"]]]), ((S, "symmetric"), ["A"])],
        "a symmetric matrix must have a symmetric derivative",
    ),
    ("ext.no-norms", [((P, "point", 4, 1), "-1")], "must not be negative"),
    ("ext.not-symmetric", below_zero, "must be positive"),
    ("ext.not-symmetric", [((S, "positive"), ["s"])], "is not a number of the statement"),
    # one arm
    ("ext.mass-range", many_parameters, "are too many"),
    ("ext.mass-at-corners", NO_PARAMETERS, "must be there"),
    ("ext.skewed", [((P, "x"), ["1"])], "must have 2 entries"),
    ("ext.chain-small", [((P, "x"), ["1"])], "must have 2 entries"),
    ("ext.chain-k_c", one_link, "must be bounded for 0 joints"),
    ("ext.chain-k_c", [((P, "squared"), [])], "must be bounded for 1 joints"),
    ("ext.chain-k_c", [((P, "squared"), ["0"])], "must be positive"),
    ("ext.chain-k_c", [((P, "rates", 0, "prices"), ["0", "0"])], "do not show the bounds of the rates of M"),
    ("ext.chain-k_c", [((S, "high"), "1")], "must be at least"),
    ("ext.links", massless, "have one without energy about its own axis"),
    ("ext.links", one_parameter, "must be none"),
    # loops
    ("ext.boxes", [((S, "kp"), "1")], "must be a list"),
    ("ext.boxes", [((S, "viscous", 0), ["1"])], "must have 2 entries"),
    # theorems
    (ARM, [((P, "met"), {"rule": "witness", "point": [], "bits": 192})], "are met by the numbers"),
    (MOVING, [((*ARGUMENT, "gravity"), True)], "has no energy where q_d(t) moves"),
    (FREE, changed_twice, "is changed twice"),
    (FREE, function_of_changed, "stands in V, and its state is changed"),
    (FREE, diagonal_of_changed, "stands for another vector here"),
    (FREE, [((*ARGUMENT, "rest"), REST)], "is for LaSalle's theorem alone"),
    (
        FREE,
        [((*ARGUMENT, "lower", "sizes"), FIVE), ((*ARGUMENT, "lower", "linear"), [])],
        "must be at most 4",
    ),
    (FREE, [((*ARGUMENT, "lower", "entries"), [])], "do not fit the sizes"),
    (FREE, [((*SYSTEM, "friction"), "plenty")], "must be one of"),
    (FREE, [((*ARGUMENT, "where"), [SMALL])], "must be about constants of this system"),
    (EXPONENTIAL, function_in_change, "must be linear, of numbers, diag(K) and states"),
    ("pub.F.10.base", [(("uses",), {"a": "0" * 64})], "a refutation rests on nothing"),
    ("pub.F.10.base", [((S, "printed"), "4\u202e0")], "is not plain Unicode text in NFC"),
    ("ext.corners", [((P, "below"), [1, 1]), ((S, "printed"), "2.2")], "is above the printed result"),
    ("pub.F.10.base", [((S, "printed"), "36")], "meets the rounding of the printed one"),
    ("pub.S5.joints", [((S, "parts"), []), ((P, "part"), 0)], "a conjunction needs at least one part"),
    ("pub.S5.joints", [((P, "part"), 0)], "must be refuted"),
    ("with-premises.sca.rate.1.m1", [((P, "covers", 0, "least"), 7)], "does not exist"),
    (
        "with-premises.sca.rate.1.m1",
        [((S, "least", 0, 0), ["dot", ["vec", "w"], ["apply", ["diag", "Kv"], ["vec", "w"]]])],
        "is not the word of its term",
    ),
    ("ext.norms", [((P, "covers", 0, "norms"), [0, 1])], "does not cover the letters"),
    ("ext.norms", [((P, "covers", 0, "norms"), [0, 1, 9])], "does not exist"),
    ("ext.no-norms", [((P, "point", 5, 1), "0")], "breaks a bound of the norms"),
    (
        "ext.no-norms",
        [((S, "given"), [{"matrix": "A", "vector": "y", "equals": ["vec", "z"]}])],
        "breaks what is given",
    ),
    ("ext.no-norms", [((P, "point", 8, 1), "0"), ((P, "point", 9, 1), "0")], "does not exceed the bound"),
    (
        "ext.norms",
        [((S, "left"), ["sin", ["dot", ["vec", "z"], ["apply", ["mat", "A"], ["vec", "y"]]]])],
        "is not a polynomial in its variables and words",
    ),
    (
        "ext.not-symmetric",
        [((S, "rates"), [[["dot", ["vec", "y"], ["vec", "z"]], ["num", "0"]]])],
        "has no derivative of its own",
    ),
    ("ext.not-symmetric", [((S, "symmetric"), ["B"])], "is not a matrix of the self"),
    (
        "ext.not-symmetric",
        [((S, "given"), [{"matrix": "A", "vector": "y", "equals": ["vec", "y"]}])],
        "occurs on a right side",
    ),
    (
        "ext.not-symmetric",
        [((S, "given"), [{"matrix": "A", "vector": "y", "equals": ["vec", "z"]}])],
        "breaks what is given",
    ),
    (
        "pub.12",
        [((S, "rates"), [[["mat", "M"], ["mat", "N"]]]), ((S, "symmetric"), ["M"])],
        "a symmetric matrix must have a symmetric derivative",
    ),
    ("ext.square", [((S, "low"), "1"), ((S, "high"), "1"), ((S, "open_low"), True)], "is empty"),
    ("ext.square", [((S, "open_low"), True)], "is no end at infinity"),
    (
        "ext.square",
        one_piece(ZERO, "<", SQUARE, "0", "1", piece(["1/2", "1"], True)),
        "is not shown to be positive",
    ),
    (
        "ext.square",
        one_piece(ONE, "<=", ["add", TWO, SQUARE], "1", "2", piece(["3/2", "2"], True)),
        "must lie above 0",
    ),
    ("ext.square", one_piece(ONE, "<=", ["add", TWO, SQUARE], "1", "2", piece(["1", "1", "2"])), "must rise"),
    (
        "ext.square",
        one_piece(["num", "3"], "<=", ["add", TWO, SQUARE], "0", "2", piece(["0", "2"])),
        "the sign is open",
    ),
    ("ext.square", one_piece(ONE, "<=", ["add", TWO, SQUARE], "1", "2", piece(["1", "3/2"])), "leaves out 2"),
    ("ext.square", one_piece(ONE, "<=", ["add", TWO, SQUARE], "1", "2", piece(["3/2", "2"])), "leaves out 1"),
    ("ext.square", one_piece(ONE, "<=", ["add", TWO, SQUARE], "1", "2", piece([])), "must be from 1 to"),
    ("ext.square", one_piece(ZERO, "<", SQUARE, "0", "1", {"rule": "Sturm"}), "does not show > at 0"),
    (
        "ext.not-small",
        [((S, "hypotheses"), [{"left": ["num", "2"], "operator": "<", "right": X}])],
        "breaks a hypothesis",
    ),
    ("ext.linked", [((P, "rate", "arms"), [])], "do not make M(q) at the corners"),
    ("ext.linked", [((S, "coupling"), ["1", "1"])], "must be none"),
    ("ext.equal-entries", [((S, "power"), 1)], "must be 0"),
    ("arc.slope", [((S, "power"), 0)], "must be 1"),
    ("ext.supremum", [((S, "component"), ["atan", X])], "is neither h_m(x) nor h_m'(x)"),
    ("eve.E.gamma.falls", [((P, "multiples", 0, "weight"), "-1")], "must be positive"),
    (
        "pub.2.8",
        [
            (
                (P,),
                {
                    "rule": "witness of an entry",
                    "entry": 0,
                    "lower": False,
                    "point": [["q2", "1"], ["q3", "1"]],
                    "bits": 128,
                },
            ),
            ((S, "entries", 0, 1), None),
            (("verdict",), "refuted"),
        ],
        "has no bound to break",
    ),
    ("ext.norms", [((S, "left"), ["vec", "z"])], "does not make a number of these"),
    ("ext.norms", [((S, "left"), ["dot", ["vec", "z"]])], "needs 2 expressions"),
    (
        "ext.mass-at-corners",
        [((S, "parameters"), [["9/10", "1"]] * 9), ((S, "mass", 0, 0, 0, 0), [0, 0] + [1] * 9)],
        "must not exceed 256",
    ),
    (
        "arc.share",
        [((S, "variables", 0, "low"), None), ((S, "variables", 0, "strict"), False)],
        "has no end that it could reach",
    ),
    (CASCADE, [((*ARGUMENT, "cascade", "motion"), ["var", "K_big"])], "must be in sizes and constants"),
    (
        CASCADE,
        [((*ARGUMENT, "rate"), {"sizes": ["norm_w"], "entries": [ONE], "linear": []})],
        "must be one of its sizes",
    ),
    (
        CASCADE,
        [((*ARGUMENT, "lower"), {"sizes": ["norm_e"], "entries": [ONE], "linear": []})],
        "must be seen by sizes that grow",
    ),
    (CASCADE, [((*ARGUMENT, "rate", "entries", 0), ["var", "s"])], "varies"),
    (CASCADE, [((*ARGUMENT, "cascade", "contraction", "entries", 0), ["var", "s"])], "varies"),
    (
        FREE,
        [((*ARGUMENT, "changes", 0, "equals", 1), ["scale", ["num", "2"], ["vec", "y_w"]])],
        "must be ±y_w",
    ),
    (
        FREE,
        [((*ARGUMENT, "lower", "linear"), [["norm_h", ONE]])],
        "must be seen by sizes that grow without end",
    ),
    (
        LASALLE,
        [((*ARGUMENT, "rest", "form"), {"sizes": ["norm_w"], "entries": [ONE], "linear": []})],
        "must be seen where the rest",
    ),
    (
        LASALLE,
        [((*ARGUMENT, "rate"), {"sizes": ["norm_e"], "entries": [ONE], "linear": []})],
        "must be seen: where it is 0",
    ),
    (
        FREE,
        [
            (
                (*ARGUMENT, "energy"),
                [
                    "add",
                    ["dot", ["vec", "Kp"], ["vec", "Uh"]],
                    ["mul", ["var", "s"], ["dot", ["vec", "w"], ["vec", "w"]]],
                ],
            )
        ],
        "stands in a term without e",
    ),
    (
        FREE,
        [((*ARGUMENT, "where"), [{"left": ["var", "zz"], "operator": "<", "right": ONE}])],
        "must be about constants",
    ),
    (FREE, [((*SYSTEM, "gains", 0), "M")], "is taken"),
    (FREE, [((*SYSTEM, "gains", 0), "K_p")], "must have no underscore"),
    (FREE, [((*SYSTEM, "functions", 0, "of"), "v")], "which is no state"),
    (
        "ext.the-origin-is-an-equilibrium",
        property_of(ISS, "the origin is an equilibrium"),
        "has an unknown torque",
    ),
    (
        "ext.V-is-positive-definite",
        property_of(CASCADE, "V is positive definite"),
        "has a V that need not see e",
    ),
    ("arc.share", [((P, "lift"), [[1, 1]])], "is not a positive monomial"),
    (
        "arc.share",
        [
            ((S, "variables", 2), {"name": "a", "low": None, "strict": True}),
            ((P, "multiples", 0, "monomial"), [[1, 1]]),
        ],
        "may be negative",
    ),
    (ARM, [((*SYSTEM, "friction"), "none")], "is none in this system"),
    ("pub.12", [((S, "left"), ["rate", ["rate", ["var", "r"]]])], "may not occur here"),
    (
        EXPONENTIAL,
        [((*ARGUMENT, "changes", 0, "state"), "e"), ((*ARGUMENT, "lower", "sizes"), ["norm_w", "norm_y_e"])],
        "is a size of its own",
    ),
    (CASCADE, state_changed_too, "must be of w alone"),
    (FREE, one_change_more("zz"), "is no state"),
    *(("gate.tru", [((S, name), value)], words) for name, value, words in GATE),
    ("gate.tru", [((P, "digits"), 0)], "must be from 1 to 1000"),
    ("gate.tru", [((S, "limits"), ["7"])], "is not shown to hold"),
    ("gate.tru", [((P, "gravity"), [])], "must be one a part"),
    ("gate.tru", [((P, "stability"), [])], "must be one a part"),
    *((SATURATED, [((P, name), value)], words) for name, value, words in AT_STATES),
    (SATURATED, [((S, "conditions"), ["19"])], "say nothing of a torque"),
    (BROKEN, [((P, "condition"), "12")], "is not among the conditions"),
    (BROKEN, [((S, "viscous"), [["2", "3"]])], "is not shown to fail"),
]
"""A good certificate of the arena, what is changed in it, and words of the reason why it is refused."""
