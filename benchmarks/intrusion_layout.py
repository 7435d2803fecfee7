"""The cells of the intrusions: people on both sides, and the same with people who come from afar, seen all the time."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from engine.document import CellDocument, SpeedAndSeparationMonitoring
from engine.document.cell import Cell
from engine.messages import Vector3

# A person who steps up: far enough away at rest that the arm may move, and able to reach all of its path.
_SHOULDER_X_M, _REST_X_M, _REST_Z_M, _BONE_M = 2.45, 2.2, 0.95, 0.75
_MAP_CENTER: Vector3 = (1.55, 0.0, 1.15)
_MAP_SIZE: Vector3 = (2.2, 1.9, 0.86)
_CAMERA_AT: Vector3 = (2.7, 2.2, 2.7)
_LOOK_AT: Vector3 = (1.5, 0.0, 1.0)


def with_people_on_both_sides(cell: Cell) -> Cell:
    """Return the cell with each person once more, mirrored at the plane y = 0."""
    people = dict(cell.document.people)
    for name, person in cell.document.people.items():
        (sx, sy, sz), (hx, hy, hz) = person.shoulder, person.hand_rests
        people[f"{name}_across"] = msgspec.structs.replace(person, shoulder=(sx, -sy, sz), hand_rests=(hx, -hy, hz))
    return _changed(cell, people=people)


def with_people_from_afar(cell: Cell) -> Cell:
    """Return the cell with its people 1.3 m from the path at rest, and map and cameras that see them there."""
    document = cell.document
    assert document.occupancy is not None
    people = {
        name: msgspec.structs.replace(
            person,
            shoulder=(_SHOULDER_X_M, *person.shoulder[1:]),
            hand_rests=(_REST_X_M, person.hand_rests[1], _REST_Z_M),
            upper_arm_m=_BONE_M,
            forearm_m=_BONE_M,
        )
        for name, person in document.people.items()
    }
    x, y, z = _CAMERA_AT
    cameras = {
        name: msgspec.structs.replace(camera, at=(x, y if camera.at[1] > 0.0 else -y, z), look_at=_LOOK_AT)
        for name, camera in document.cameras.items()
    }
    occupancy = msgspec.structs.replace(document.occupancy, center_m=_MAP_CENTER, size_m=_MAP_SIZE)
    return _changed(cell, people=people, cameras=cameras, occupancy=occupancy)


def with_separation_monitoring(cell: Cell) -> Cell:
    """Return the cell with speed and separation monitoring."""
    return _changed(cell, speed_and_separation_monitoring=SpeedAndSeparationMonitoring())


def _changed(cell: Cell, **changes: object) -> Cell:
    document: CellDocument = msgspec.structs.replace(cell.document, **changes)
    return replace(cell, document=document)
