"""The kinds of statement, one file a kind: data, form, text, proofs and the rules that judge them.

Importing a kind enters its rules in ``verify.RULES``; whoever reads statements of any kind calls ``load``. A
new kind is a new file here and its name below.
"""

from importlib import import_module

KINDS = (
    "agrees",
    "all_of",
    "bound_every_n",
    "compared",
    "constant",
    "coriolis",
    "damping",
    "decreasing",
    "every_n",
    "for_all",
    "for_small",
    "gravity",
    "identity",
    "implies",
    "inertia",
    "loop_property",
    "norm_bound",
    "resting",
    "settling",
    "theorem",
    "trigonometric",
)


def load() -> None:
    """Import every kind, so that all rules are known."""
    for name in KINDS:
        import_module(f"{__name__}.{name}")
