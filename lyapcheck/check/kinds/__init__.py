"""The kinds of statement, one file a kind: data, form, text, proofs and the rules that judge them.

Importing a kind enters its rules in ``verify.RULES``; whoever reads statements of any kind calls ``load``. A
new kind is a new file here, and nothing else need know of it.
"""

from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules


def load() -> None:
    """Import every file of this folder, whatever a certificate names, so that all rules are known."""
    for file in iter_modules([str(Path(__file__).parent)]):
        import_module(f"{__name__}.{file.name}")
