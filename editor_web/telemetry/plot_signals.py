"""Numeric fields of messages for plots: their paths, labels and units, and fast reading of one field."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import cast

import msgspec

MAX_FIELDS = 200
"""Maximum number of fields of one topic."""
MAX_ROW = 40
"""Maximum length of a list with selectable fields; longer lists are data, not signals."""
MAX_DEPTH = 5
_UNITS = {
    "m": "m",
    "rad": "rad",
    "s": "s",
    "n": "N",
    "nm": "Nm",
    "kg": "kg",
    "hz": "Hz",
    "px": "px",
    "percent": "%",
    "m_s": "m/s",
    "rad_s": "rad/s",
    "m_s2": "m/s²",
    "rad_s2": "rad/s²",
    "nm_rad": "Nm/rad",
    "deg": "°",
    "v": "V",
    "a": "A",
}
_INDEX = re.compile(r"[0-9]{1,4}")
_OWN_TIME = "time_s"
"""Creation time of a message; plots use the server's time instead."""
_BY_NAME = {"xyz": "m"}
_AXES = {"xyz": "xyz", "xyzw": "xyzw", "force_n": "xyz", "torque_nm": "xyz"}
Path = tuple[str | int, ...]


class SignalField(msgspec.Struct, frozen=True, kw_only=True):
    """One numeric field of a topic: its path `position_rad.0`, its label `position_rad joint1`, its unit."""

    path: str
    label: str
    unit: str


def signal_fields(message: object) -> tuple[SignalField, ...]:
    """Return the numeric fields of a message, in order; booleans count as 0 and 1."""
    fields: list[SignalField] = []
    for field in _walk(message, (), (), "", 0):
        if field.path != _OWN_TIME:
            fields.append(field)
        if len(fields) == MAX_FIELDS:
            break
    return tuple(fields)


def path_of(text: str) -> Path:
    """Parse a path such as `position_rad.0`."""
    return tuple(int(part) if _INDEX.fullmatch(part) else part for part in text.split("."))


def number_at(message: object, path: Path) -> float | None:
    """Return the number of a message at `path`; None if there is none."""
    value: object = message
    for step in path:
        match value:
            case msgspec.Struct() if isinstance(step, str) and step in value.__struct_fields__:
                value = getattr(value, step)
            case Mapping():
                value = cast("Mapping[object, object]", value).get(str(step))
            case list() | tuple() if isinstance(step, int):
                row = cast("list[object]", value)
                value = row[step] if step < len(row) else None
            case _:
                return None
    if not isinstance(value, bool | int | float):
        return None
    number = float(value)
    return number if math.isfinite(number) else None


def unit_of(name: str) -> str:
    """Return the unit from the suffix of a field name, `width_m`; empty if it has none."""
    parts = name.lower().split("_")
    for length in (2, 1):
        unit = _UNITS.get("_".join(parts[-length:])) if len(parts) > length else None
        if unit is not None:
            return unit
    return _BY_NAME.get(name, "")


def _walk(value: object, path: Path, words: tuple[str, ...], unit: str, depth: int) -> Iterator[SignalField]:
    if isinstance(value, bool | int | float):
        if path:
            yield SignalField(path=".".join(map(str, path)), label=" ".join(words), unit=unit)
        return
    if depth == MAX_DEPTH:
        return
    for step, word, own, inner in _parts(value, path):
        yield from _walk(inner, (*path, step), (*words, word), own or unit, depth + 1)


def _parts(value: object, path: Path) -> Iterator[tuple[str | int, str, str, object]]:
    """Yield the parts of a value: path step, label word, unit if the name has one, and the part."""
    match value:
        case msgspec.Struct():
            row = _names_of(getattr(value, "names", ()))
            for name in value.__struct_fields__:
                yield name, name, unit_of(name), _named(getattr(value, name), row)
        case _Row():
            for index, word in enumerate(value.names):
                yield index, word, "", value.items[index]
        case Mapping():
            mapping = cast("Mapping[object, object]", value)
            row = _names_of(mapping.get("names"))
            for key, inner in mapping.items():
                if "." not in str(key):
                    yield str(key), str(key), unit_of(str(key)), _named(inner, row)
        case list() | tuple():
            items = cast("list[object]", value)
            if len(items) <= MAX_ROW:
                axes = _AXES.get(str(path[-1]) if path else "", "")
                for index, inner in enumerate(items):
                    yield index, axes[index] if len(axes) == len(items) else str(index), "", inner
        case _:
            return


class _Row:
    """A row whose items have the names in the message's `names`."""

    def __init__(self, items: tuple[object, ...], names: tuple[str, ...]) -> None:
        self.items = items
        self.names = names


def _names_of(names: object) -> tuple[str, ...]:
    """Return the names of the items of a message's rows, where it has them."""
    if not isinstance(names, tuple | list) or len(cast("list[object]", names)) > MAX_ROW:
        return ()
    return tuple(str(each) for each in cast("list[object]", names))


def _named(value: object, names: tuple[str, ...]) -> object:
    """Return a row with its names; any other value as it is."""
    items = tuple(cast("list[object]", value)) if names and isinstance(value, tuple | list) else ()
    return _Row(items, names) if items and len(items) == len(names) else cast("object", value)
