"""Tool changers of robots, and what makes a part of the cell a tool that they take.

A tool is a part: it lies in its hanger by contact, and `at` is its place there. The frame of the part is the centre of
its tool plate; z points away from the arm, and the face at -z meets the face of the master plate at the flange.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.duration import Duration
from engine.document.placement import Length, Name, Placement
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.messages import Vector3

_LENGTHS = {"box": 3, "cylinder": 2, "sphere": 1}


class ToolChangerSpec(StrictModel, frozen=True, kw_only=True):
    """The master plate of a tool changer at the flange of a robot: a cylinder, with a lock for tool plates.

    The lock catches a tool whose plate is within `tolerance_m` and `tolerance_rad` of the master plate when its piston
    has travelled, and holds it with at most `force_n` and `torque_nm`. A `self_holding` lock stays shut without air.
    Its sensors are a switch at the piston, `locked`, which tells a shut lock with a tool from one that is open or shut
    on nothing, and a switch in the face, `present`.
    """

    diameter_m: Length = 0.063
    thickness_m: Length = 0.03
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass of the master plate in kilograms")] = 0.3
    tolerance_m: Annotated[float, Meta(gt=0.0, le=0.01, description="Distance at which plates meet, in metres")] = 0.001
    tolerance_rad: Annotated[float, Meta(gt=0.0, le=0.1, description="Tilt and turn at which plates meet")] = 0.0175
    force_n: Annotated[float, Meta(gt=0.0, description="Force in any direction that the lock holds, in N")] = 500.0
    torque_nm: Annotated[float, Meta(gt=0.0, description="Torque about any axis that the lock holds, in N m")] = 40.0
    time: Annotated[Duration, Meta(description="Time that the piston travels")] = 0.2
    self_holding: bool = True
    output: Annotated[Name, Meta(description="Output that shuts the lock while it is on")] = "tool_lock"
    locked: Annotated[Name, Meta(description="Sensor at the piston")] = "tool_locked"
    present: Annotated[Name, Meta(description="Sensor in the face of the master plate")] = "tool_present"


class ToolShape(StrictModel, frozen=True, kw_only=True):
    """A body that is fixed to the plate of a tool; `at` is its centre in the frame of the tool."""

    shape: Literal["box", "cylinder", "sphere"]
    size_m: tuple[Length, ...]
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass in kilograms, above 0")]
    at: Placement = Placement()


class ToolSpec(StrictModel, frozen=True, kw_only=True):
    """What makes a part a tool: bodies beside its plate, and tool centre points by name, in the frame of the tool.

    The first tool centre point is the one that the arm has after it has taken the tool.
    """

    tcps: Annotated[dict[Name, Placement], Meta(min_length=1)]
    shapes: tuple[ToolShape, ...] = ()


def centre_of_mass(plate_kg: float, tool: ToolSpec) -> tuple[float, Vector3]:
    """Return the mass of a tool with its plate, in kg, and its centre of mass in the frame of the tool."""
    total = plate_kg + sum(one.mass_kg for one in tool.shapes)
    x, y, z = (sum(one.mass_kg * one.at.xyz[axis] for one in tool.shapes) / total for axis in range(3))
    return total, (x, y, z)


def require_changer(
    name: str, changer: ToolChangerSpec | None, source: DocumentSource, *, tool: bool, simulated: bool
) -> None:
    """Require that a robot with a tool changer has no fixed tool, and is simulated.

    Raises:
        DocumentError: `where` is the position.
    """
    if changer is None or (simulated and not tool):
        return
    reason = "has both a gripper and a tool changer" if tool else "has a driver: tool changers are only simulated"
    raise DocumentError(
        f"robot `{name}` {reason}",
        where=source.position(("robots", name, "tool_changer"), of_key=True),
        hint="remove the gripper; tools that are changed are parts with `tool:`" if tool else "use `driver: sim`",
    )


def require_tools(tools: Mapping[str, tuple[str, ToolSpec | None]], source: DocumentSource) -> None:
    """Require that bodies of tools have sizes that fit, and plates a face; `tools` are shapes of plates, and tools.

    Raises:
        DocumentError: `where` is the position.
    """
    for name, (plate, tool) in tools.items():
        if tool is None:
            continue
        if plate == "sphere":
            raise DocumentError(
                f"the plate of the tool `{name}` is a sphere, which has no face",
                where=source.position(("parts", name, "shape")),
                hint="make it a box or a cylinder",
            )
        for index, one in enumerate(tool.shapes):
            due = _LENGTHS[one.shape]
            if len(one.size_m) != due:
                path: DataPath = ("parts", name, "tool", "shapes", index, "size_m")
                raise DocumentError(
                    f"the size of a {one.shape} has {due} lengths, not {len(one.size_m)}",
                    where=source.position(path),
                    hint="box: edge lengths x, y, z; cylinder: diameter, length; sphere: diameter",
                )
