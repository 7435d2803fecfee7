"""Devices on equipment: each of their outputs and sensors is the pin of the same name."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from engine.document.cell_devices import DeviceSpec
from engine.document.equipment import Equipment
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.wording import did_you_mean


def refuse_equipment(devices: Mapping[str, DeviceSpec], source: DocumentSource) -> None:
    """Refuse equipment in a module; raises DocumentError."""
    for name, device in devices.items():
        if device.equipment is not None:
            raise DocumentError(
                f"device `{name}` names equipment, which a module does not know",
                where=source.position(("devices", name, "equipment")),
                hint="give it to the module in the cell: `modules: {NAME: {module: …, equipment: …}}`",
            )


def require_device_pins(
    devices: Mapping[str, DeviceSpec],
    source: DocumentSource,
    modules: Collection[str],
    equipment: Collection[str],
    pins: Mapping[str, Equipment],
    *,
    has_world: bool,
) -> None:
    """Require that something moves each device: a world, or equipment that has all its pins, where they are known.

    `modules` and `equipment` are the names of the cell, `pins` the documents of its equipment.

    Raises:
        DocumentError: `where` is the position of the device or its module, or of the name of the equipment.
    """
    for name, device in devices.items():
        module = name.partition("/")[0]
        path: DataPath = ("modules", module) if module in modules else ("devices", name)
        if device.equipment is None:
            if not has_world:
                hint = "give it `equipment:` with its pins, or the cell a world: `world: {kind: mujoco}`"
                where = source.position(path, of_key=True)
                raise DocumentError(f"nothing moves the device `{name}`", where=where, hint=hint)
            continue
        for message, hint in _problems(name, device, device.equipment, equipment, pins):
            raise DocumentError(message, where=source.position((*path, "equipment")), hint=hint)


def _problems(
    name: str, device: DeviceSpec, on: str, equipment: Collection[str], pins: Mapping[str, Equipment]
) -> Iterator[tuple[str, str]]:
    if on not in equipment:
        yield f"the cell has no equipment `{on}`", did_you_mean(on, equipment) if equipment else "add `equipment:`"
    if on not in pins:
        return
    file, document = pins[on].file.name, pins[on].document
    yield from _missing(f"`{name}` sets the output", device.outputs, document.outputs, file)
    yield from _missing(f"`{name}` has the sensor", device.sensors, document.inputs, file)


def _missing(words: str, names: Iterable[str], pins: Collection[str], file: str) -> Iterator[tuple[str, str]]:
    for name in names:
        if name not in pins:
            kind = "output" if words.endswith("output") else "input"
            hint = f"did you mean one of its {kind}s {', '.join(pins)}?" if pins else f"it has no {kind}"
            yield f"{words} `{name}`, which {file} does not have", hint
