"""Statements on both sides of a border, with proofs: what must be accepted, and why the others are refused.

Each is put into a good certificate of the arena in place of its statement and proof.
"""

from collections.abc import Callable
from fractions import Fraction

from tests.arena.attacks import Document, Edits

S, P = "statement", "proof"
ZERO, ONE, TWO, X = ["num", "0"], ["num", "1"], ["num", "2"], ["var", "x"]
SQUARE = ["pow", X, 2]

Row = tuple[str, Edits | Callable[[Document], Edits], str]
ACCEPTED = ""


def claimed(statement, proof, verdict="proved", grade="exact"):
    return [((S,), statement), ((P,), proof), (("verdict",), verdict), (("grade",), grade)]


def relation(left, operator, right):
    return {"left": left, "operator": operator, "right": right}


def numbers(left, operator, right, verdict):
    """A relation between numbers, by exact numbers."""
    statement = {"kind": "Constant", "relation": relation(left, operator, right)}
    return claimed(statement, {"rule": "exact numbers"}, verdict)


BALLS = {"rule": "separate balls", "bits": 128}
ROOT = ["sqrt", TWO]
NUMBERS = [
    ("pub.T2.pd.base", numbers(ONE, "<", ONE, "proved"), "the proof gives refuted"),
    ("pub.T2.pd.base", numbers(ONE, "<", ONE, "refuted"), ACCEPTED),
    ("pub.T2.pd.base", numbers(ONE, "<=", ONE, "proved"), ACCEPTED),
    ("pub.T2.pd.base", numbers(TWO, "<=", ONE, "proved"), "the proof gives refuted"),
    ("pub.T2.pd.base", numbers(ROOT, "<", ROOT, "refuted"), ACCEPTED),
    (
        "pub.T2.pd.base",
        claimed({"kind": "Constant", "relation": relation(ROOT, "<=", ROOT)}, BALLS, grade="enclosure"),
        "are too few to tell both sides apart",
    ),
]


def printed(text, proof, verdict="proved"):
    """That x, printed as 2.0, is printed as this."""
    statement = {"kind": "Agrees", "formula": X, "inputs": [["x", "2.0"]], "printed": text, "solve_for": None}
    return claimed(statement, {**proof, "bits": 128}, verdict, "enclosure")


def corners(below, above):
    return {"rule": "corners of the roundings", "below": below, "above": above}


INSIDE, OUTSIDE = {"rule": "printed inputs"}, {"rule": "outside the roundings"}
PRINTED = [
    ("ext.corners", change, words)
    for change, words in (
        (printed("2.0", INSIDE), ACCEPTED),
        (printed("1.9", INSIDE), "leaves the rounding"),
        (printed("2.1", INSIDE), "leaves the rounding"),
        (printed("1.8", OUTSIDE, "refuted"), ACCEPTED),
        (printed("2.2", OUTSIDE, "refuted"), ACCEPTED),
        (printed("1.9", OUTSIDE, "refuted"), "meets the rounding"),
        (printed("2.0", OUTSIDE, "refuted"), "meets the rounding"),
        (printed("2.02", corners([0], [1])), ACCEPTED),
        (printed("2.02", corners([1], [1])), "is above the printed result"),
        (printed("2.02", corners([0], [0])), "is below the printed result"),
        (printed("2.02", corners([0], [2])), "must say 0 or 1 for each input"),
        (printed("2.02", corners([], [1])), "must say 0 or 1 for each input"),
    )
]


def for_all(holds, low, high, *pieces, ends="[]"):
    """A relation for all x in an interval; ``ends`` are its brackets."""
    statement = {
        "kind": "ForAll",
        "relation": holds,
        "low": low,
        "high": high,
        "open_low": ends[0] == "(",
        "open_high": ends[1] == ")",
        "variable": "x",
    }
    proof = {"rule": "pieces of the domain", "pieces": list(pieces)}
    grade = "exact" if pieces and pieces[0]["rule"] == "Sturm" else "enclosure"
    return claimed(statement, proof, grade=grade)


def boxes(*cuts, ends=""):
    """Taylor boxes between cuts; beside 0 and up to infinity by the dominant term, if ``ends`` says so."""
    piece = {"rule": "Taylor boxes", "bits": 64, "cuts": list(cuts)}
    return {**piece, "from_zero": "0" in ends, "to_infinity": "∞" in ends}


STURM = {"rule": "Sturm"}
MINUS_X, MINUS_ONE = ["neg", X], ["num", "-1"]
POSITIVE, NONNEGATIVE = relation(ZERO, "<", SQUARE), relation(ZERO, "<=", SQUARE)
AT_MOST_ONE, BELOW_ONE = relation(X, "<=", ONE), relation(X, "<", ONE)
FOR_ALL = [
    ("ext.square", change, words)
    for change, words in (
        (for_all(NONNEGATIVE, None, None, STURM, STURM), ACCEPTED),
        (for_all(POSITIVE, None, None, STURM, STURM), "does not show > at 0"),
        (for_all(POSITIVE, "0", "1", STURM, ends="(]"), ACCEPTED),
        (for_all(BELOW_ONE, "1/2", "1", STURM), "does not give the sign"),
        (for_all(AT_MOST_ONE, "0", "1", STURM), ACCEPTED),
        (for_all(AT_MOST_ONE, "-1", "1", STURM), "must be 2"),
        (for_all(AT_MOST_ONE, "-1", "1", STURM, STURM), ACCEPTED),
        (for_all(relation(MINUS_X, "<=", ONE), "-2", "1", STURM, STURM), "does not give the sign"),
        (for_all(relation(MINUS_X, "<=", TWO), "-2", "-1", STURM), ACCEPTED),
        (for_all(relation(MINUS_X, "<=", ONE), "-2", "-1", STURM), "does not give the sign"),
        (for_all(relation(X, "<=", MINUS_ONE), "-2", "-1", STURM), ACCEPTED),
        (for_all(relation(X, "<=", MINUS_ONE), "-2", "0", STURM), "does not give the sign"),
        (for_all(POSITIVE, "1", "1", boxes("1")), ACCEPTED),
        (for_all(relation(ONE, "<=", SQUARE), "1", "1", boxes("1")), "the sign is open"),
        (for_all(POSITIVE, "1", "1", boxes("1"), ends="()"), "is empty"),
        (for_all(POSITIVE, "1", "1", boxes("1"), ends="[)"), "is empty"),
        (for_all(POSITIVE, "2", "1", boxes("1")), "is empty"),
        (for_all(POSITIVE, "1", None, boxes("1", ends="∞")), ACCEPTED),
        (for_all(relation(ZERO, "<", ["sin", X]), "1", None, boxes("1", ends="∞")), "no term dominates"),
        (for_all(POSITIVE, "1", None, boxes("1", "2")), "leaves out infinity"),
        (for_all(POSITIVE, "1", None, boxes("1", ends="∞"), ends="[)"), "is no end at infinity"),
        (for_all(relation(TWO, "<", SQUARE), "1", "2", boxes("2")), "leaves out 1"),
        (for_all(relation(SQUARE, "<", ["num", "4"]), "1", "3", boxes("1")), "leaves out 3"),
        (for_all(relation(ZERO, "<=", X), "0", "1", boxes("0", "1", ends="0")), "must lie above 0"),
        (for_all(relation(X, "<=", ZERO), "0", "1", boxes("1/2", "1", ends="0")), "is too far from 0"),
    )
]


def for_small(conclusion, *hypotheses):
    """A relation for every small enough ε > 0 and all x > 0, which fails for small ε at x = 1."""
    statement = {
        "kind": "ForSmall",
        "small": "eps",
        "bounded": [],
        "variables": [{"low": "0", "name": "x", "strict": True}],
        "hypotheses": list(hypotheses),
        "conclusion": conclusion,
    }
    proof = {"rule": "failure for small values", "point": [["x", "1"]], "below": "1"}
    return claimed(statement, proof, "refuted", "enclosure")


EPS = ["var", "eps"]
X_BELOW_EPS = relation(X, "<", EPS)
FOR_SMALL = [
    ("ext.not-small", change, words)
    for change, words in (
        (for_small(relation(X, "<", X)), ACCEPTED),
        (for_small(relation(X, "<=", X)), "does not break the conclusion"),
        (for_small(relation(["neg", EPS], "<", ZERO)), "does not break the conclusion"),
        (for_small(X_BELOW_EPS, relation(X, "<=", X)), ACCEPTED),
        (for_small(X_BELOW_EPS, relation(X, "<", X)), "breaks a hypothesis"),
        (for_small(X_BELOW_EPS, relation(EPS, "<", X)), ACCEPTED),
        (for_small(X_BELOW_EPS, relation(X, "<=", EPS)), "breaks a hypothesis"),
    )
]


def constant_mass(a, b, c):
    """M = (a b; b c) of two joints, the same at every q."""
    a_, b_, c_ = ([] if x == "0" else [[[0, 0, 0, 0], x]] for x in (a, b, c))
    return [[a_, b_], [b_, c_]]


def at_x(kind, mass, bound, *x):
    """A bound of M that fails in the direction of x."""
    statement = {"kind": kind, "mass": mass, "parameters": [], **bound}
    proof = {"rule": "posture", "q": ["0", "0"], "parameters": [], "x": list(x), "y": []}
    return claimed(statement, proof, "refuted", "enclosure")


def scaled(directions, times):
    """With directions a hundred times as long, and so many times the bound."""

    def change(document):
        lengthened = [[str(100 * Fraction(x)) for x in document[P][name]] for name in directions]
        high = str(times * Fraction(document[S]["high"]))
        places = [((P, name), x) for name, x in zip(directions, lengthened, strict=True)]
        return [*places, ((S, "high"), high)]

    return change


COUPLED, DOUBLE = constant_mass("2", "1", "2"), constant_mass("2", "0", "2")
FAILS_NOT = "does not show that the bound fails"
ONE_ARM = [
    *(
        ("rob.lambda_max.lower", change, words)
        for change, words in (
            (at_x("MassAbove", DOUBLE, {"low": "3"}, "1/2", "0"), ACCEPTED),
            (at_x("MassAbove", DOUBLE, {"low": "2"}, "1", "0"), FAILS_NOT),
            (at_x("MassAbove", DOUBLE, {"low": "1"}, "1/2", "0"), FAILS_NOT),
            (at_x("MassBelow", DOUBLE, {"high": "1"}, "1/2", "0"), ACCEPTED),
            (at_x("MassBelow", DOUBLE, {"high": "-1"}, "1/2", "0"), ACCEPTED),
            (at_x("MassBelow", DOUBLE, {"high": "2"}, "2", "0"), FAILS_NOT),
            (at_x("MassBelow", DOUBLE, {"high": "3"}, "2", "0"), FAILS_NOT),
        )
    ),
    ("rob.k_c.lower", scaled(["x", "y"], 1), ACCEPTED),
    *(("rob.k_c.lower", scaled(names, 2), FAILS_NOT) for names in (["x"], ["y"], ["x", "y"])),
    ("ext.chain-coriolis", scaled(["x"], 1), ACCEPTED),
    ("ext.chain-coriolis", scaled(["x"], 100), FAILS_NOT),
]
POWER = ["dot", ["vec", "w"], ["apply", ["diag", "Kv"], ["vec", "hw"]]]
PRODUCT = ["dot", ["vec", "z"], ["vec", "y"]]


def at_least(left, number, least, right=ZERO, norms=()):
    """left ≤ right for every n, where a number is at least something, by this alone."""
    statement = {
        "kind": "BoundEveryN",
        "left": left,
        "right": right,
        "symmetric": [],
        "rates": [],
        "given": [],
        "norms": [[[["vec", "z"]], ["var", "t"]]],
        "least": [[number, least]],
    }
    return claimed(statement, {"rule": "covered terms", "covers": [{"least": 0, "norms": list(norms)}]})


SIGN, WORD = "is for terms with a minus", "is not the word of its term"
EVERY_N = [
    ("ext.norms", change, words)
    for change, words in (
        (at_least(["neg", POWER], POWER, ZERO), ACCEPTED),
        (at_least(["neg", POWER], POWER, ONE, MINUS_ONE), ACCEPTED),
        (at_least(["neg", POWER], POWER, ONE, ["num", "-2"]), "is not shown to exceed the sum of the bounds"),
        (at_least(["neg", ["mul", ["var", "t"], POWER]], POWER, ZERO), ACCEPTED),
        (at_least(POWER, POWER, ZERO), SIGN),
        (at_least(["neg", POWER], POWER, ZERO, norms=[0]), SIGN),
        (at_least(["neg", ["mul", POWER, POWER]], POWER, ZERO), WORD),
        (at_least(["neg", ["mul", POWER, PRODUCT]], POWER, ZERO), WORD),
        (at_least(["neg", POWER], ["mul", TWO, POWER], ONE), WORD),
    )
]


def implies(conclusion, *variables, given=None, **proof):
    """What an identity of signs shows, with one hypothesis or none."""
    statement = {
        "kind": "Implies",
        "variables": [{"name": name, "low": low, "strict": strict} for name, low, strict in variables],
        "hypotheses": [] if given is None else [given],
        "conclusion": conclusion,
    }
    return claimed(statement, {"rule": "identity of signs", "lift": [], "multiples": [], **proof})


def once(monomial):
    """The one hypothesis times a monomial."""
    return [{"hypothesis": 0, "monomial": monomial, "weight": "1"}]


REAL, FROM_0, ABOVE_0, FROM_2 = (("x", None, True), ("x", "0", False), ("x", "0", True), ("x", "2", False))
CUBE, X_Y = ["pow", X, 3], ["mul", X, ["var", "y"]]
X_POSITIVE, X_NONNEGATIVE = relation(ZERO, "<", X), relation(ZERO, "<=", X)
NEGATIVE = "has a term that may be negative"
SIGNS = [
    ("arc.share", change, words)
    for change, words in (
        (implies(NONNEGATIVE, REAL), ACCEPTED),
        (implies(POSITIVE, REAL), NEGATIVE),
        (implies(relation(ZERO, "<=", ["neg", SQUARE]), REAL), NEGATIVE),
        (implies(relation(ZERO, "<=", CUBE), FROM_0), ACCEPTED),
        (implies(relation(ZERO, "<", CUBE), ABOVE_0), ACCEPTED),
        (implies(relation(ZERO, "<=", CUBE), REAL), NEGATIVE),
        (implies(relation(ZERO, "<", CUBE), FROM_0), NEGATIVE),
        (implies(relation(ZERO, "<=", X_Y), REAL, ("y", None, True)), NEGATIVE),
        (implies(relation(ZERO, "<=", ["sqrt", X]), REAL), NEGATIVE),
        (implies(relation(ZERO, "<=", ["div", ONE, X]), REAL), "denominator whose sign is not plain"),
        (implies(relation(TWO, "<=", X), FROM_2), ACCEPTED),
        (implies(relation(TWO, "<", X), FROM_2), NEGATIVE),
        (implies(relation(["num", "3"], "<=", X), FROM_2), NEGATIVE),
        (implies(X_POSITIVE, REAL, given=X_POSITIVE, multiples=once([])), ACCEPTED),
        (implies(X_POSITIVE, REAL, given=X_NONNEGATIVE, multiples=once([])), NEGATIVE),
        (implies(X_NONNEGATIVE, REAL, given=relation(X, "<=", ZERO), multiples=once([])), NEGATIVE),
        (implies(X_NONNEGATIVE, REAL, lift=[[0, 1]]), "is not a positive monomial"),
        (
            implies(
                relation(ZERO, "<", X_Y), REAL, ("y", "0", True), given=X_POSITIVE, multiples=once([[1, 1]])
            ),
            ACCEPTED,
        ),
        (
            implies(
                relation(ZERO, "<", X_Y), REAL, ("y", "0", False), given=X_POSITIVE, multiples=once([[1, 1]])
            ),
            NEGATIVE,
        ),
    )
]


def form(z, *lower, d):
    """Squares of a vector of monomials."""
    return {"monomials": z, "lower": list(lower), "diagonal": d}


NO_SQUARES = form([], d=[])


def squared(conclusion, *products, variables=(REAL,), given=(), lift=NO_SQUARES):
    """What a sum of squares shows; a product is a form, with the hypothesis and the monomial, if any."""
    statement = {
        "kind": "Implies",
        "variables": [{"name": name, "low": low, "strict": strict} for name, low, strict in variables],
        "hypotheses": list(given),
        "conclusion": conclusion,
    }
    parts = [{"hypothesis": None, "monomial": [], **one} for one in products]
    return claimed(statement, {"rule": "sum of squares", "lift": lift, "products": parts})


def times(squares, hypothesis=None, monomial=()):
    return {"squares": squares, "hypothesis": hypothesis, "monomial": list(monomial)}


Y, REALS = ["var", "y"], (REAL, ("y", None, True))
BOTH = ["add", SQUARE, ["pow", Y, 2]]
ALL, OF_1, OF_X = [[[0, 1]], [[1, 1]]], form([[]], [], d=["1"]), form([[[0, 1]]], [], d=["1"])
OF_BOTH, WITH_1 = form(ALL, [], ["0"], d=["1", "1"]), form([[], [[0, 1]]], [], ["0"], d=["1", "1"])
FLAT = form([[], [[0, 1]]], [], ["0"], d=["1", "0"])
LESS_X = form([[[0, 1]]], [], d=["-1"])
LESS_1, SINE = form([[]], [], d=["-1"]), ["sin", X]
AT_MOST_0, BELOW_0 = relation(X, "<=", ZERO), relation(X, "<", ZERO)
OPEN, DIFFER = "is not shown to be strict", "both sides differ"


def above_0(*given):
    """0 < x² + y², if something holds."""
    return squared(relation(ZERO, "<", BOTH), times(OF_BOTH), variables=REALS, given=given)


SQUARES = [
    ("sos.form", change, words)
    for change, words in (
        (squared(NONNEGATIVE, times(OF_X)), ACCEPTED),
        (squared(POSITIVE, times(OF_X)), OPEN),
        (squared(POSITIVE, times(OF_X), variables=[FROM_0]), OPEN),
        (squared(POSITIVE, times(OF_X), variables=[ABOVE_0]), ACCEPTED),
        (squared(relation(ZERO, "<=", ["neg", SQUARE]), times(LESS_X)), "must not be negative"),
        (squared(NONNEGATIVE, times(form([[[0, 1]]], [], d=["2"]))), DIFFER),
        (squared(relation(ZERO, "<=", ["div", SQUARE, TWO]), times(OF_X)), DIFFER),
        (
            squared(relation(ZERO, "<=", ["div", SQUARE, TWO]), times(form([[[0, 1]]], [], d=["1/2"]))),
            ACCEPTED,
        ),
        (squared(POSITIVE, times(OF_1, 0), given=[POSITIVE]), ACCEPTED),
        (squared(POSITIVE, times(OF_1, 0), given=[NONNEGATIVE]), OPEN),
        (squared(POSITIVE, times(OF_1, 1), given=[POSITIVE]), "does not exist"),
        (squared(POSITIVE, times(OF_1, -1), given=[POSITIVE]), "does not exist"),
        (squared(relation(ZERO, "<=", ["neg", X]), times(OF_1, 0), given=[X_NONNEGATIVE]), DIFFER),
        (above_0(), OPEN),
        (above_0(X_NONNEGATIVE), OPEN),
        (above_0(X_POSITIVE), ACCEPTED),
        (above_0(relation(["num", "-1"], "<", X)), OPEN),
        (above_0(relation(ONE, "<=", X)), ACCEPTED),
        (above_0(relation(ZERO, "<=", Y), relation(Y, "<", ZERO)), ACCEPTED),
        (squared(POSITIVE, times(OF_X), variables=REALS, given=[relation(ZERO, "<", Y)]), OPEN),
        (squared(relation(ZERO, "<", ["add", SQUARE, ONE]), times(WITH_1)), ACCEPTED),
        (squared(relation(ZERO, "<", ONE), times(FLAT), given=[NONNEGATIVE]), OPEN),
        (squared(relation(ZERO, "<=", ONE), times(FLAT), given=[NONNEGATIVE]), ACCEPTED),
        (squared(relation(ZERO, "<", ONE), times(WITH_1), lift=OF_X, given=[NONNEGATIVE]), ACCEPTED),
        (squared(relation(ZERO, "<", ONE), times(OF_1), lift=OF_X, given=[NONNEGATIVE]), DIFFER),
        (
            squared(relation(ZERO, "<", ONE), times(FLAT), lift=LESS_X, given=[NONNEGATIVE]),
            "must not be negative",
        ),
        (squared(relation(ZERO, "<=", CUBE), times(OF_X, monomial=[[0, 1]])), "may be negative"),
        (
            squared(relation(ZERO, "<=", CUBE), times(OF_X, monomial=[[0, 1]]), variables=[FROM_0]),
            ACCEPTED,
        ),
        (squared(relation(ZERO, "<", CUBE), times(OF_X, monomial=[[0, 1]]), variables=[FROM_0]), OPEN),
        (squared(relation(ZERO, "<", CUBE), times(OF_X, monomial=[[0, 1]]), variables=[ABOVE_0]), ACCEPTED),
        (squared(relation(TWO, "<=", X), times(OF_1, monomial=[[0, 1]]), variables=[FROM_2]), ACCEPTED),
        (squared(relation(TWO, "<", X), times(OF_1, monomial=[[0, 1]]), variables=[FROM_2]), OPEN),
        (squared(relation(ONE, "<", X), times(OF_1, monomial=[[0, 1]]), variables=[FROM_2]), DIFFER),
        (squared(NONNEGATIVE, times(form([[[0, 1]]], d=["1"]))), "one a monomial"),
        (squared(NONNEGATIVE, times(form([[[0, 1]]], ["0"], d=["1"]))), "one a monomial"),
        (squared(NONNEGATIVE, times(form([[[0, 1]]], [], d=[]))), "must have 1 entries"),
        (
            squared(NONNEGATIVE, times(form([[[1, 1]]], [], d=["1"]))),
            "must be of variables, sines and cosines alone",
        ),
        (squared(NONNEGATIVE, times(form([[[9, 1]]], [], d=["1"]))), "does not exist"),
        (squared(NONNEGATIVE, times(form([[[0, 65]]], [], d=["0"]))), "must be at most 64"),
        (squared(NONNEGATIVE, *[times(OF_X)] * 201), "must be at most 200"),
        (squared(relation(ZERO, "<=", ["mul", ROOT, SQUARE]), times(OF_X)), "between polynomials"),
        (
            squared(NONNEGATIVE, times(OF_X), given=[relation(["exp", X], "<=", ONE)]),
            "between polynomials",
        ),
        (squared(NONNEGATIVE, times(OF_X), given=[relation(SINE, "<=", ONE)]), ACCEPTED),
        (squared(POSITIVE, times(OF_X), given=[relation(SINE, "<", ZERO)]), OPEN),
        (squared(relation(["pow", SINE, 2], "<=", ONE), times(form([[[2, 1]]], [], d=["1"]))), ACCEPTED),
        (squared(relation(["pow", SINE, 2], "<=", ONE), times(form([[[1, 1]]], [], d=["1"]))), DIFFER),
        (squared(AT_MOST_0, times(LESS_1, 0), given=[X_NONNEGATIVE, AT_MOST_0]), ACCEPTED),
        (squared(AT_MOST_0, times(LESS_1, 0), given=[X_NONNEGATIVE]), "must not be negative"),
        (squared(BELOW_0, times(LESS_1, 0), given=[X_NONNEGATIVE, AT_MOST_0]), OPEN),
        (
            squared(AT_MOST_0, times(LESS_1, 0), given=[X_NONNEGATIVE, relation(X, "<=", ONE)]),
            "must not be negative",
        ),
        (
            squared(relation(ZERO, "<=", ["div", SQUARE, ["add", SQUARE, ONE]]), times(OF_X)),
            "between polynomials",
        ),
    )
]


def rests(family, m, torque, error):
    """That one joint with k_p = 1 rests within an error."""
    sizes = {"kp": ["1"], "torque": [torque], "errors": [error]}
    statement = {"kind": "Resting", "family": family, "m": m, **sizes}
    return claimed(statement, {"rule": "h at the bounds"}, grade="enclosure")


def rests_beyond(error, bound="1/2", joint=0):
    """A state of rest of tanh, held by half of k_p."""
    sizes = {"kp": ["1"], "torque": ["1/2"], "errors": [bound]}
    statement = {"kind": "Resting", "family": "tanh", "m": None, **sizes}
    proof = {"rule": "state of rest", "joint": joint, "error": error}
    return claimed(statement, proof, "refuted", "enclosure")


TOO_LARGE = "is not shown to be as large"
NOT_SHOWN = "has a box on which P ≻ 0 is not shown"
OF_LOOPS = [
    ("ext.boxes", [((S, "viscous", 0), ["1", "20"])], ACCEPTED),
    ("ext.boxes", [((S, "viscous", 0), ["1", "100"])], NOT_SHOWN),
    ("ext.linked", [((S, "viscous", 0), ["5", "13/2"])], ACCEPTED),
    ("ext.linked", [((S, "viscous", 0), ["5", "600"])], "do not show dV/dt < 0"),
    ("ext.boxes", [((S, "kv"), ["40"])], "K̃ and ε₀ must be positive"),
]
RESTS = [
    ("ext.resting", rests("hyperbolic", 2, "99/100", "6/5"), ACCEPTED),
    ("ext.resting", rests("hyperbolic", 2, "1", "6/5"), TOO_LARGE),
    ("ext.resting", rests("hyperbolic", 2, "21/20", "6/5"), TOO_LARGE),
    ("ext.resting", rests("tanh", None, "0", "0"), ACCEPTED),
    ("ext.resting", rests("tanh", None, "1/2", "11/20"), ACCEPTED),
    ("ext.resting", rests("tanh", None, "1/2", "1/2"), TOO_LARGE),
    ("ext.not-resting", rests_beyond("21/40"), ACCEPTED),
    ("ext.not-resting", rests_beyond("11/20"), "is not shown to be held"),
    ("ext.not-resting", rests_beyond("1/2"), "must be beyond the bound"),
    ("ext.not-resting", rests_beyond("21/40", bound=None), "must be beyond the bound"),
    *(("ext.not-resting", rests_beyond("21/40", joint=joint), "must be from 0 to 0") for joint in (-1, 1)),
]
BORDERS = [*NUMBERS, *PRINTED, *FOR_ALL, *FOR_SMALL, *ONE_ARM, *EVERY_N, *SIGNS, *SQUARES, *OF_LOOPS, *RESTS]
"""A good certificate of the arena, what stands in its place, and words of the reason why it is refused."""
