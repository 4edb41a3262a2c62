"""Names of a package that are imported from their homes when they are first used."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import Any


def exporter(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """A ``__getattr__`` for a package.

    Args:
        package: its full name.
        homes: the module of each name, within the package; ``module:name`` where that differs.
    """

    def find(name: str) -> Any:
        import sys
        from importlib import import_module

        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, _, inside = homes[name].partition(":")
        value = getattr(import_module(f"{package}.{module}"), inside or name)
        setattr(sys.modules[package], name, value)
        return value

    return find
