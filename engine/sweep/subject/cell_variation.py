"""A cell with other values than its document has: what the factors of a sweep change in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import cast

from engine.document.cell import Cell, cell_of_source
from engine.document.simulated_devices import with_simulated_devices
from engine.document.text.yaml_source import DataPath
from engine.errors import DocumentError
from engine.sweep.subject.joined_displacement import carried_parts
from engine.wording.suggestions import did_you_mean

_AXES = ("x_m", "y_m", "z_m")
_YAW = 2
Data = dict[str, object]


def varied_cell(cell: Cell, values: Mapping[str, object]) -> Cell:
    """Return a cell with the values of its factors; others in `values` are ignored.

    A displacement is added to the written pose of a part: metres along the axes of the world, and radians about its
    z axis; what is joined to it is displaced with it. Paths of files stay relative to the document.

    Args:
        cell: The cell as written.
        values: Values by address, `displace.PART.x_m` or `cell.PATH`.

    Raises:
        DocumentError: a factor names nothing in the cell, the cell with this value is invalid, or a device is real in
            it that is simulated in the cell.
    """
    data = cell.source.data
    for address, value in values.items():
        kind, _, rest = address.partition(".")
        if kind == "cell":
            path: DataPath = tuple(int(step) if step.isdecimal() else step for step in rest.split("."))
            data = _with_value(data, path, value, address)
        elif kind == "displace":
            data = _displaced(cell, data, address, value)
    if data is cell.source.data:
        return cell
    varied = cell_of_source(replace(cell.source, data=data), file=cell.file)
    displaced = {address.split(".")[1] for address in values if address.startswith("displace.")}
    for name, at in carried_parts(cell, varied.document, displaced):
        data = _with_value(data, ("parts", name, "at"), {"xyz": list(at.xyz), "rpy": list(at.rpy)}, f"displace.{name}")
        varied = cell_of_source(replace(cell.source, data=data), file=cell.file)
    varied = with_simulated_devices(varied, tuple(cell.simulated))
    for device, driver in varied.document.real_devices.items():
        if device not in cell.document.real_devices:
            hint = "a sweep drives no real devices: vary something else"
            raise DocumentError(f"a factor gives `{device}` the driver `{driver}`", where=cell.file, hint=hint)
    return varied


def written_value(cell: Cell, path: str) -> object:
    """Return the value at `PATH.TO.VALUE` of a cell document; None where none is written."""
    value = cell.source.data
    for step in path.split("."):
        if isinstance(value, dict):
            value = cast("Data", value).get(step)
        elif isinstance(value, list) and step.isdecimal() and int(step) < len(cast("list[object]", value)):
            value = cast("list[object]", value)[int(step)]
        else:
            return None
    return value


def _displaced(cell: Cell, data: object, address: str, value: object) -> object:
    _, part, axis = address.split(".")
    if part not in cell.document.parts:
        raise DocumentError(
            f"the cell has no part `{part}`", where=address, hint=did_you_mean(part, cell.document.parts)
        )
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise DocumentError(f"a displacement is a number, not {value!r}", where=address, hint="in m or rad")
    parts = cast("Mapping[str, Mapping[str, Mapping[str, Sequence[float]]]]", cast("Data", data)["parts"])
    written = cell.document.parts[part].at
    # An earlier factor may have displaced the part along another axis.
    place = parts[part].get("at", {})
    key, nominal = ("rpy", written.rpy) if axis == "yaw_rad" else ("xyz", written.xyz)
    numbers = list(place.get(key, nominal))
    numbers[_YAW if axis == "yaw_rad" else _AXES.index(axis)] += value
    return _with_value(data, ("parts", part, "at"), {**place, key: numbers}, address)


def _with_value(data: object, path: DataPath, value: object, address: str) -> object:
    """Return plain data with another value at a path; everything beside the path is shared."""
    if not path:
        return value
    step, rest = path[0], path[1:]
    if isinstance(data, dict):
        mapping = cast("Data", data)
        # A key may be one that the document leaves at its default; the model refuses those that do not exist.
        return {**mapping, str(step): _with_value(mapping.get(str(step), {} if rest else None), rest, value, address)}
    if isinstance(data, list) and isinstance(step, int):
        items = cast("list[object]", data)
        if step < len(items):
            return [*items[:step], _with_value(items[step], rest, value, address), *items[step + 1 :]]
        raise DocumentError(f"the list has {len(items)} values", where=address, hint="they are numbered from 0")
    raise DocumentError(f"there is nothing named `{step}` in {data!r:.60}", where=address, hint="write it in the cell")
