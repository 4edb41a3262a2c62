"""A file a command: ``arguments`` says what it takes, ``run`` does it, and has its help as docstring."""

from importlib import import_module
from types import ModuleType

from lyapcheck.extensions import folders, modules

__path__ += folders(__name__)

NAMES = modules(__path__)


def load(name: str) -> ModuleType:
    """The module of a command, with all that the command line needs to know of it."""
    return import_module(f"{__name__}.{name}")
