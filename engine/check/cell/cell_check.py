"""Checks cell and entries documents: existing models and drivers, consistent names, plausible units."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from engine.cell.cell_names import CellNameKind, CellNames, cell_names
from engine.cell.robot_models import RobotModels, robot_models
from engine.check.cell.driver_checks import check_drivers
from engine.check.cell.mesh_checks import check_meshes
from engine.check.finding import Finding, finding_sort_key, new_finding
from engine.check.values.magnitude import UnitSuspicion, unit_suspicion, unit_suspicions
from engine.document.cell import Cell, CellDocument
from engine.document.entries_document import Entries, EntriesDocument, load_entries
from engine.document.robot_spec import RobotSpec
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError, FlexcellError, Position
from engine.wording.suggestions import did_you_mean

_PART_FRAME = "part"
"""The frame of the part that a pose is used for."""


def check_cell(cell: Cell) -> tuple[Finding, ...]:
    """Return the findings of a cell and of its seed entries, without connecting to a device."""
    names = cell_names(cell)
    models = robot_models()
    findings = list(_suspect(cell.source, CellDocument))
    for robot, entry in cell.document.robots.items():
        if models is not None:
            findings += _check_models(cell, robot, entry, models)
    findings += check_drivers(cell)
    for camera, entry in cell.document.cameras.items():
        for part in entry.detect.labels if entry.detect is not None else ():
            path: DataPath = ("cameras", camera, "detect", "labels", part)
            findings += _missing(names, "part", part, cell.source.position(path, of_key=True))
    findings += _check_unknown_space(cell)
    findings += _check_separation(cell)
    findings += check_meshes(cell.document.fixtures, cell.source, cell.file.parent)
    findings += _check_seed(cell, names)
    return tuple(sorted(findings, key=finding_sort_key))


def check_entries_document(entries: Entries, names: CellNames | None = None) -> tuple[Finding, ...]:
    """Return the findings of entries: suspect units and, with the names of a cell, unknown frames."""
    findings = list(_suspect(entries.source, EntriesDocument))
    for name, pose in entries.document.poses.items():
        suspicion = unit_suspicion("xyz", pose.xyz, "m", steps=("poses", name, "xyz"))
        findings += [_suspected(entries.source, suspicion)] if suspicion is not None else []
        # Arms accept their base as a frame, states that handle parts any body of the cell.
        if names is not None and pose.frame != _PART_FRAME:
            findings += _missing(names, "frame", pose.frame, entries.source.position(("poses", name, "frame")))
    return tuple(sorted(findings, key=finding_sort_key))


def _check_unknown_space(cell: Cell) -> Iterator[Finding]:
    occupancy = cell.document.occupancy
    if occupancy is None or not cell.document.cameras or occupancy.must_cover or occupancy.unknown_space is not None:
        return
    position = cell.source.position(("occupancy",), of_key=True)
    message = "motions may pass through space that no camera has seen"
    hint = "name what the cameras must see in `must_cover`, or choose `unknown_space`"
    yield new_finding("unseen-space-accepted", message, path="", position=position, hint=hint)


def _check_separation(cell: Cell) -> Iterator[Finding]:
    document, occupancy = cell.document, cell.document.occupancy
    if document.speed_and_separation_monitoring is None or occupancy is None:
        return
    for name, person in document.people.items():
        for key, point in (("shoulder", person.shoulder), ("hand_rests", person.hand_rests)):
            edges = zip(point, occupancy.center_m, occupancy.size_m, strict=True)
            beyond_m = max(abs(at - centre) - size / 2.0 for at, centre, size in edges)
            if beyond_m > 0.0:
                position = cell.source.position(("people", name, key))
                message = f"the {key} of person `{name}` is {beyond_m:.2f} m beyond the map, where nothing is measured"
                hint = "make the box of `occupancy` larger, so that people are measured before they are near"
                yield new_finding("person-beyond-map", message, path="", position=position, hint=hint)


def _check_models(cell: Cell, robot: str, entry: RobotSpec, models: RobotModels) -> Iterator[Finding]:
    here: DataPath = ("robots", robot)
    named: list[tuple[str, str, DataPath, tuple[str, ...]]] = [
        ("robot", entry.model, (*here, "model"), models.robots())
    ]
    if entry.gripper is not None:
        named.append(("gripper", entry.gripper.model, (*here, "gripper", "model"), models.tools()))
    unknown = [each for each in named if not _is_folder(each[1]) and each[1] not in each[3]]
    for what, model, path, known in unknown:
        message, hint = f"there is no {what} model `{model}`", did_you_mean(model, known)
        yield new_finding("unknown-model", message, path="", position=cell.source.position(path), hint=hint)
    if unknown:
        return
    try:
        summary = models.summary(cell, robot)
    except FlexcellError as error:
        position = error.where if isinstance(error.where, Position) else cell.source.position((*here, "model"))
        message = f"robot `{robot}`: {error.message}"
        yield new_finding("unknown-model", message, path="", position=position, hint=error.hint or "")
        return
    for what, numbers, count in (
        ("output", entry.outputs, summary.digital_outputs),
        ("input", entry.inputs, summary.digital_inputs),
    ):
        for name, number in numbers.items():
            if number >= count:
                hint = f"a {entry.model} has {f'the {what}s 0 to {count - 1}' if count else f'no {what}s'}"
                position = cell.source.position((*here, f"{what}s", name))
                message = f"`{robot}` has no {what} {number}"
                yield new_finding("unknown-in-cell", message, path="", position=position, hint=hint)


def _check_seed(cell: Cell, names: CellNames) -> tuple[Finding, ...]:
    seed = cell.seed_file
    if seed is None:
        return ()
    try:
        return check_entries_document(load_entries(seed), names)
    except DocumentError as error:
        message, position = error.message, error.where
        if not seed.is_file() or not isinstance(position, Position):
            message, position = f"{seed.name}: {message}", cell.source.position(("store", "seed"))
        return (new_finding("invalid-document", message, path="", position=position, hint=error.hint or ""),)


def _missing(names: CellNames, kind: CellNameKind, name: str, position: Position) -> Iterator[Finding]:
    if not names.has(kind, name):
        message, hint = names.missing(kind, name), names.advice(kind, name)
        yield new_finding("unknown-in-cell", message, path="", position=position, hint=hint)


def _suspect(source: DocumentSource, model: Any) -> Iterator[Finding]:
    yield from (_suspected(source, found) for found in unit_suspicions(model, source.data))


def _suspected(source: DocumentSource, found: UnitSuspicion) -> Finding:
    position = source.position(found.steps)
    return new_finding("suspect-unit", found.message, path="", position=position, hint=found.hint)


def _is_folder(model: str) -> bool:
    return model.startswith(".") or "/" in model
