"""Immutable records that cost nothing to import: ``dataclasses`` loads longer than Python starts."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from dataclasses import Field
    from typing import Any, ClassVar, dataclass_transform
else:

    def dataclass_transform(**options):
        """What it marks is for type checkers alone."""
        return lambda cls: cls


class _DataclassFields:
    """The fields as ``dataclasses`` wants to see them, made when they are first asked for."""

    def __get__(self, record: object, cls: type[Record]) -> dict[str, Field[Any]]:
        from dataclasses import make_dataclass

        twin: Any = make_dataclass(cls.__name__, cls._names)
        found: dict[str, Field[Any]] = twin.__dataclass_fields__
        return found


@dataclass_transform(frozen_default=True)
class Record:
    """The base of records: the annotated names of a subclass are its fields, like a frozen dataclass.

    Equality, hash and text follow from the fields; ``dataclasses.replace``, ``fields`` and ``asdict`` work. A
    default is shared by all records, so it must be immutable.
    """

    _names: ClassVar[tuple[str, ...]] = ()

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    else:
        __dataclass_fields__ = _DataclassFields()

        def __init__(self, *values, **named):
            names = self._names
            if named or len(values) != len(names):
                values = self._completed(values, named)
            self.__dict__.update(zip(names, values, strict=True))

    def __init_subclass__(cls) -> None:
        cls._names = (*cls._names, *cls.__annotations__)

    def _completed(self, values: tuple[Any, ...], named: dict[str, Any]) -> tuple[Any, ...]:
        """The values of all fields, from those given by place, by name and by default."""
        rest = self._names[len(values) :]
        unknown = [name for name in named if name not in rest]
        missing = [name for name in rest if name not in named and not hasattr(type(self), name)]
        if unknown or missing or len(values) > len(self._names):
            wrong = ", ".join(unknown or missing) or "too many values"
            raise TypeError(f"{type(self).__name__}: {wrong} {'missing' if missing else 'not expected'}")
        return (*values, *(named[name] if name in named else getattr(type(self), name) for name in rest))

    def _key(self) -> tuple[Any, ...]:
        return tuple([getattr(self, name) for name in self._names])

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={getattr(self, name)!r}" for name in self._names)
        return f"{type(self).__name__}({shown})"

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} is immutable: {name} cannot be set")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__} is immutable: {name} cannot be removed")
