"""Records are frozen dataclasses in all that users of them see."""

from __future__ import annotations

import copy
import dataclasses
import pickle

import pytest

from lyapcheck.records import Record


class Point(Record):
    """A place."""

    x: int
    y: int = 2
    name: str = ""

    @property
    def size(self) -> int:
        """Distance along the axes."""
        return abs(self.x) + abs(self.y)


class Named(Point):
    """More fields after those of the base."""

    unit: str = "m"


@dataclasses.dataclass(frozen=True)
class Twin:
    """The same as ``Point``."""

    x: int
    y: int = 2
    name: str = ""


@pytest.mark.parametrize("values", [(1,), (1, 3), (1, 3, "a")])
def test_a_record_is_built_compared_and_shown_like_a_dataclass(values: tuple[object, ...]) -> None:
    record, twin = Point(*values), Twin(*values)  # type: ignore[arg-type]
    assert repr(record) == repr(twin).replace("Twin", "Point")
    assert dataclasses.asdict(record) == dataclasses.asdict(twin)
    assert record == Point(**dataclasses.asdict(twin))
    assert hash(record) == hash(copy.copy(record))
    assert record != twin
    assert record != Point(9, 9)


def test_records_can_be_replaced_copied_and_sent() -> None:
    record = Point(1, name="a")
    changed = dataclasses.replace(record, y=5)
    assert (changed.x, changed.y, changed.name, changed.size) == (1, 5, "a", 6)
    assert record.y == 2
    assert pickle.loads(pickle.dumps(record)) == copy.deepcopy(record) == record
    assert [field.name for field in dataclasses.fields(Named(1))] == ["x", "y", "name", "unit"]
    assert Named(1, unit="km") != Named(1) != Point(1)


@pytest.mark.parametrize(
    ("values", "named"), [((), {}), ((1, 2, "", 4), {}), ((1,), {"z": 1}), ((1,), {"x": 1}), ((), {"y": 1})]
)
def test_wrong_fields_are_refused(values: tuple[int, ...], named: dict[str, int]) -> None:
    with pytest.raises(TypeError, match="Point"):
        Point(*values, **named)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        Twin(*values, **named)  # type: ignore[arg-type]


def test_a_record_does_not_change() -> None:
    record = Point(1)
    with pytest.raises(AttributeError, match="x"):
        record.x = 2  # type: ignore[misc]
    with pytest.raises(AttributeError, match="y"):
        del record.y
