"""The libraries that lyapcheck asks, and what to say where one of them is not installed."""

from __future__ import annotations

from importlib.util import find_spec

TYPE_CHECKING = False  # so that nothing is imported that is not used
if TYPE_CHECKING:
    from lyapcheck.errors import InputError

PACKAGES = {
    "casadi": "casadi",
    "clarabel": "clarabel",
    "cvxpy": "cvxpy",
    "flint": "python-flint",
    "jinja2": "jinja2",
    "latex2mathml": "latex2mathml",
    "matplotlib": "matplotlib",
    "numpy": "numpy",
    "rich": "rich",
    "scipy": "scipy",
    "shtab": "shtab",
    "sympy": "sympy",
    "yaml": "pyyaml",
}
"""What a module is called where packages are installed; python-flint alone judges gains and certificates."""
RULE = "is not installed, and this needs it"


def installed(module: str) -> bool:
    """Whether a library is there; it is not imported."""
    return find_spec(module) is not None


def repair(module: str) -> str:
    """The line that installs a library."""
    return f"pip install {PACKAGES[module]}"


def missing(error: ImportError) -> InputError | None:
    """What to say of an import that has failed; none where it is not of a library that may be missing."""
    module = (error.name or "").partition(".")[0]
    return lacking(module) if module in PACKAGES else None


def lacking(module: str) -> InputError:
    """The error for a library that is not installed."""
    from lyapcheck.errors import argument_error

    return argument_error("library", PACKAGES[module], RULE, repair(module))
