"""Every key of the files that users write; a test holds this table against what the readers ask for."""

from typing import NamedTuple


class Key(NamedTuple):
    """One key of a table of a file. ``default`` is ``required`` if there is none."""

    name: str
    type: str
    unit: str
    default: str
    example: str
    about: str


PER_JOINT = "numbers, one per joint"
NUMBER = "number or table of a number"
VECTOR = "3 numbers"
PERIOD = "text"

LOOP = (
    Key("rate", "number > 0", "Hz", "none", "400", "Sampling rate. Without it the controller is continuous."),
    Key("period", PERIOD, "s, ms or us", "none", '"2.5 ms"', "Sampling period, in place of `rate`."),
    Key("longest", PERIOD, "s, ms or us", "the period", '"3 ms"', "Longest interval between two readings."),
    Key("delay", "whole number 0–1000", "samples", "1", "1", "Delay from a reading to its torque."),
    Key(
        "velocity",
        "`difference` or `measured`",
        "",
        "`difference`",
        '"measured"',
        "Source of the joint velocity.",
    ),
    Key("filter", "1–100 numbers", "", "none", "[0.5, 0.5]", "Taps of the velocity filter, newest first."),
    Key(
        "lowpass", "number > 0", "Hz", "none", "50", "Cut-off of a first-order filter, in place of `filter`."
    ),
    Key(
        "encoder",
        "text or whole number",
        "bits or counts per turn",
        "that of the arm",
        '"17 bits"',
        "Encoder of every joint.",
    ),
    Key(
        "unknown_payload",
        "number ≥ 0",
        "kg",
        "0",
        "2",
        "Mass at the last link that the controller does not know.",
    ),
    Key(
        "gravity_error",
        "number 0–1000",
        "%",
        "0",
        "5",
        "Error of the file's g(q), which the controller uses.",
    ),
    Key(
        "within",
        "number, at most 3600",
        "degrees",
        "none",
        "90",
        "Prove stability for starts at rest this near to the goal.",
    ),
)
GAINS = (
    Key("name", "text", "", "required", '"tuned"', "Name of the gain set, different for each set."),
    Key("m", "whole number ≥ 1", "", "required for `hyperbolic`", "3", "Order of the family h_m."),
    Key("family", "text", "", "`hyperbolic`", '"linear"', "Bounded function h. `linear` is PD control with gravity compensation."),
    Key("angle", "`rad` or `deg`", "", "`rad`", '"deg"', "Angle unit of the gains of `linear`."),
    Key("kp", f"{PER_JOINT}, or a table by joint name", "N·m", "required", "[25, 50, 5]", "Diagonal of K_p. For `linear` in N·m per angle."),
    Key("kv", f"{PER_JOINT}, or a table by joint name", "N·m", "required", "[0.223, 0.223, 0.223]", "Diagonal of K_v. For `linear` in N·m·s per angle. The gate also reads 0."),
    Key("condition", "list of conditions", "", "the default of the gate", '["10p", "19"]', "[Conditions](conditions.md) that decide about this set."),
)  # fmt: skip
MOTOR = (
    Key("name", "text", "", "required", '"shoulder"', "Name of the joint, different for each joint."),
    Key("viscous", NUMBER, "N·m·s/rad", "required; with `urdf` from that file", "0.5", "Viscous friction. 0 means that none is known."),
    Key("coulomb", NUMBER, "N·m", "none", "7.17", "Coulomb friction, also called dry friction."),
    Key("torque_limit", NUMBER, "N·m", "none", "150", "Largest torque of the motor."),
    Key("encoder", "whole number ≥ 1", "counts per turn", "none", "1024000", "Resolution of the encoder."),
    Key("gravity_bound", NUMBER, "N·m", "computed", "40.28", "Bound k_gi of the gravity torque, if a source prints it."),
    Key("rotor_inertia", f"{NUMBER}, or a table of `rotor` and `gear`", "kg·m²", "0", "0.8", "Inertia of the rotor as the joint feels it."),
)  # fmt: skip

FILES = {
    "gain": {
        "": (
            Key("robot", "text", "", "none", '"buap3"', "Built-in arm, or the path of an arm file."),
            Key("condition", "list of conditions", "", "the default of the gate", '["10p", "19"]', "[Conditions](conditions.md) that decide about all sets of the file."),
            Key("certificates", "path", "", "none", '"proofs"', "Folder of certificates. The gate verifies its proofs of `global` and `sampled` again before any search."),
            Key("gains", "tables", "", "required", "see below", "One table for each gain set."),
            Key("bounds", "table", "", "none", "see below", "Numbers that replace those of the arm."),
            Key("loop", "table", "", "none", "see below", "The loop as a computer runs it."),
        ),
        "[[gains]]": GAINS,
        "[bounds]": (
            Key("viscous_min", "number > 0", "N·m·s/rad", "from the arm", "0.406", "λmin(B)."),
            Key("torque", PER_JOINT, "N·m", "from the arm", "[50, 150, 15]", "Torque limits."),
            Key("gravity", PER_JOINT, "N·m", "from the arm", "[0, 40.28, 1.81]", "Bounds of the gravity torques."),
        ),
        "[loop]": LOOP,
    },
    "arm": {
        "": (
            Key("title", "text", "", "required", '"My arm"', "One line for reports."),
            Key("source", "text", "", "none", '"a data sheet"', "Where the plain numbers are printed."),
            Key("remarks", "list of texts", "", "none", '["The rod is rigid."]', "Further assumptions, one sentence each."),
            Key("gravity", VECTOR, "m/s²", "required with `links`", "[0, 0, -9.81]", "Gravity in the base frame."),
            Key("links", "tables", "", "one of `links`, `model`, `urdf`", "see below", "A chain of at most 12 links."),
            Key("joints", "tables", "", "required with `model`", "see below", "Motors of a printed model or of a URDF file."),
            Key("numbers", "table", "", "none", "{ b = 0.084 }", "Named numbers for the terms of `model`."),
            Key("model", "table", "", "one of `links`, `model`, `urdf`", "see below", "Printed M and potential energy."),
            Key("printed", "table", "", "none", "see below", "Printed C and g, only to be compared."),
            Key("urdf", "text", "", "one of `links`, `model`, `urdf`", '"arm.urdf"', "Path of a URDF, xacro or MJCF file."),
            Key("base", "text", "", "the first link", '"base_link"', "With `urdf`: the link where the chain begins."),
            Key("tip", "text", "", "the last link", '"hand"', "With `urdf`: the link where the chain ends."),
            Key("fixed", "table by joint name", "rad or m", "none", "{ lift = 0.2 }", "With `urdf`: joints that are held."),
            Key("xacro", "table by argument name", "", "none", '{ tool = "gripper" }', "With `urdf`: arguments of a xacro file."),
            Key("loop", "table", "", "none", "see below", "The loop as a computer runs it."),
        ),
        "[[links]]": (
            *MOTOR,
            Key("type", "text", "", "`revolute`", '"revolute"', "Only `revolute` and `continuous` joints are read."),
            Key("axis", VECTOR, "", "required", "[0, 1, 0]", "Axis of the joint, of rational length."),
            Key("origin", VECTOR, "m", "required", "[0, 0, 0.2]", "Position of the joint, from the joint before it or from the base."),
            Key("mass", NUMBER, "kg", "required", "2", "Mass of the link."),
            Key("com", VECTOR, "m", "required", "[0, 0, 0.1]", "Centre of mass, from the joint."),
            Key("inertia", f"{NUMBER}, or a table", "kg·m²", "required", "{ ixx = 0.3, iyy = 0.3, izz = 0.2 }", "Inertia about the centre of mass. One number is enough if all axes are parallel."),
        ),
        "[[joints]]": (*MOTOR, Key("type", "text", "", "`revolute`", '"revolute"', "Only `revolute` and `continuous` joints are read.")),
        "inertia = { … }": tuple(
            Key(name, NUMBER, "kg·m²", "required" if name[1] == name[2] else "0", "0.3", "Entry of the inertia tensor.")
            for name in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        ),
        "rotor_inertia = { … }": (
            Key("rotor", NUMBER, "kg·m²", "required", "5e-5", "Inertia of the rotor alone."),
            Key("gear", "number > 0", "", "required", "100", "Gear ratio. The joint feels rotor·gear²."),
        ),
        "Table of a number": (
            Key("value", "number", "that of the key", "required", "23.902", "Nominal value, read exactly."),
            Key("unit", "text", "", "that of the key", '"kg"', "Only the unit of the key is accepted."),
            Key("source", "text", "", "that of the file", '"data sheet"', "Where the number is printed."),
            Key("assumed", "true or false", "", "false", "true", "True if no source prints the number. Then `note` or `source` is required."),
            Key("low", "number", "that of the key", "no range", "23", "Smallest value. Needs `high`."),
            Key("high", "number", "that of the key", "no range", "25", "Largest value. Needs `low`."),
            Key("note", "text", "", "none", '"a guess"', "Reason for the value."),
        ),
        "[model]": (
            Key("M11", "list of terms", "kg·m²", "required", '[[2.351, ""], [0.168, "c2"]]', "Entry of M. The same for every entry on and above the diagonal."),
            Key("potential", "list of terms", "J", "required", '[[-38.46501, "c1"]]', "Potential energy."),
        ),
        "[printed]": (
            Key("C11", "list of terms", "kg·m²", "none", '[[-0.168, "s2 w2"]]', "Entry of C(q, q̇). Each term has one joint velocity `w1`, `w2`, …"),
            Key("g1", "list of terms", "N·m", "none", '[[38.46501, "s1"]]', "Entry of g(q)."),
        ),
        "[loop]": LOOP,
    },
    "plan": {
        "": (
            Key("robots", "list of texts", "", "required", '["buap3"]', "Built-in arms, or paths of arm files."),
            Key("variations", "list of lists of texts", "", "[[]]", '[[], ["viscous=-30%..+0%"]]', "Ranges as `--vary` reads them. An empty list is the arm itself."),
            Key("questions", "list of texts", "", "required", '["gate", "epsilon"]', "What is computed for each arm and gain set."),
            Key("gains", "tables", "", "none", "see below", "Gain sets one by one."),
            Key("grid", "table", "", "none", "see below", "Gain sets by rows."),
            Key("gate", "table", "", "none", "see below", "Options of the question `gate`."),
            Key("epsilon", "table", "", "none", "see below", "Options of the question `epsilon`."),
            Key("bounds", "table", "", "none", "see below", "Options of the question `bounds`."),
            Key("simulate", "table", "", "none", "see below", "Options of the question `simulate`."),
            Key("robot", "table", "", "none", "see below", "Options of the question `robot`."),
        ),
        "[[gains]]": GAINS,
        "[grid]": (
            Key("m", "list, or a row `{ from, to, step }`", "", "required", "[1, 2, 3]", "Orders of the family."),
            Key("kp", "list, or a row `{ from, to, step }`", "N·m", "required", "[[25, 50, 5]]", "Values of K_p. One number is used for every joint."),
            Key("kv", "list, or a row `{ from, to, step }`", "N·m", "required", "{ from = 0.05, to = 0.5, step = 0.05 }", "Values of K_v. One number is used for every joint."),
        ),
        "[gate]": (
            Key("condition", "list of conditions", "", "[]", '["10i", "scalar"]', "[Conditions](conditions.md) in place of those of each set."),
            Key("loop", "list of texts", "", "[]", '["rate=1000"]', "Options of the loop, as on the command line."),
        ),
        "[epsilon]": (
            Key("max_boxes", "whole number > 0", "boxes", "100000", "20000", "Limit of branch and bound."),
            Key("starts", "whole number > 0", "", "30", "30", "Starting points of the search for a counterexample."),
        ),
        "[bounds]": (
            Key("delta", "number > 0", "°", "1.0", "2", "Error that counts as reached."),
            Key("time", "number > 0", "s", "10.0", "10", "Duration of the simulation."),
            Key("target", "numbers, one per joint", "°", "that of the arm", "[45, 45, 90]", "Desired joint angles."),
            Key("start", "numbers, one per joint", "°", "0", "[0, 0, 0]", "Initial joint angles."),
        ),
        "[simulate]": (
            Key("time", "number > 0", "s", "5.0", "5", "Duration of the simulation."),
            Key("experiment", "true or false", "", "false", "true", "Simulate sampling, friction and motor limits."),
            Key("target", "numbers, one per joint", "°", "that of the arm", "[45, 45, 90]", "Desired joint angles."),
            Key("start", "numbers, one per joint", "°", "0", "[0, 0, 0]", "Initial joint angles."),
        ),
        "[robot]": (Key("max_boxes", "whole number > 0", "boxes", "2000", "20000", "Limit of boxes for each bound."),),
    },
    "reference": {
        'kind = "sine"': (
            Key("kind", "text", "", "required", '"sine"', "q_di = offset + amplitude · sin(2π · frequency · t + phase)."),
            Key("amplitude", PER_JOINT, "°", "required", "[20, 30, 40]", "Amplitude."),
            Key("frequency", PER_JOINT, "Hz", "required", "[0.5, 0.5, 0.25]", "Frequency, at most 1000."),
            Key("phase", PER_JOINT, "°", "0", "[0, 90, 0]", "Phase."),
            Key("offset", PER_JOINT, "°", "0", "[0, 45, 0]", "Mean angle."),
        ),
        'kind = "minimum-jerk"': (
            Key("kind", "text", "", "required", '"minimum-jerk"', "One motion that starts and ends at rest."),
            Key("from", PER_JOINT, "°", "required", "[0, 0, 0]", "First joint angles."),
            Key("to", PER_JOINT, "°", "required", "[45, 45, 90]", "Last joint angles."),
            Key("duration", "number", "s", "required", "2", "Duration, from 0.001 to 3600."),
        ),
    },
}  # fmt: skip
"""The keys of each kind of file, by table."""
