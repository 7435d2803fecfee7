"""The names that a cell offers to behaviors, by kind, from its document and its models.

Used by checks and by the editor's pick lists. Nothing is connected or simulated. A parameter of a state declares its
kind of name: `Meta(extra_json_schema={"cell_name": "robot"})`. With `"of": "robot"` beside it, the name is relative
to the value of the parameter `robot` of the same state: `panda_hand` is `left/panda_hand`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final

from engine.cell.drivers.driver import Driver
from engine.cell.drivers.driver_assignments import assigned_drivers
from engine.cell.robot_models import RobotModels, RobotSummary, robot_models, tool_kinds
from engine.document.cell import Cell
from engine.document.equipment import EquipmentDocument
from engine.document.robot_spec import RobotSpec
from engine.errors import FlexcellError
from engine.state import Skills
from engine.wording.suggestions import did_you_mean

CellNameKind = str
"""One of the kinds of names below, or the name of a kind of tool: then a robot with such a tool."""
_KINDS = frozenset((
    "robot", "tool", "link", "output", "input", "pwm_output", "part", "person", "camera", "detector", "label", "frame",
    "arm_frame", "body", "obstacle", "scene_part", "device", "position", "hexapod_pose", "module", "connector",
    "planner", "topic", "unit_place", "bus_topic", "skill", "controller", "equipment", "changeable_tool",
    "tool_changer", "tool_point",
))  # fmt: skip
"""`tool` (`left/gripper`), `link` (`left/panda_hand`), `output` (`left/3`, `left/gripper`) and `input` (`left/3`,
`left/door`) belong to a robot or equipment, `pwm_output` (`lights/lamp`) to equipment, `label` (`eye/plate`) to a
camera with a detector, `position` (`vice/closed`), `hexapod_pose` and `unit_place` to a device, `tool_point`
(`probe/tip`) to a tool of a tool changer. `arm_frame` is a frame in which an arm accepts poses, `frame` a frame of
the cell's view; those that the cell document names are both. `body`, `obstacle` and `scene_part` are objects of the
planning scene, to which behaviors add. `tool_changer` is a robot that has one, `changeable_tool` a part that it
takes. `topic` is one that the cell document declares. `controller` is a robot or `equipment`: both have outputs and
inputs. `bus_topic` is any topic, `skill` any service or action: only an open cell knows those."""

_WORDS: Mapping[str, str] = {
    "detector": "camera that detects",
    "arm_frame": "frame for the poses of an arm",
    "body": "body",
    "scene_part": "part",
    "changeable_tool": "part that is a tool",
    "tool_changer": "robot with a tool changer",
    "tool_point": "tool centre point",
    "controller": "robot or equipment",
    "hexapod_pose": "pose",
    "pwm_output": "PWM output",
    "unit_place": "place",
}
_OWNED = frozenset[CellNameKind]((
    "tool", "link", "output", "input", "pwm_output", "label", "position", "hexapod_pose", "unit_place",
    "tool_point",
))  # fmt: skip
_OF_PATHS = frozenset[CellNameKind](("position", "hexapod_pose", "unit_place", "tool_point"))
"""Those of them whose owner may stand on a module: `vice/jaws/closed`."""
_GROWING = frozenset[CellNameKind](("body", "obstacle", "scene_part"))
_WORLD, _OCCUPANCY = "world", "occupancy"


@dataclass(frozen=True, kw_only=True)
class CellNames:
    """The names of a cell; a kind that is missing from `by_kind` is unknown, and any name of it is accepted.

    `undescribed` are robots whose model cannot be read, equipment whose pins only its server knows, and people, whose
    bodies only a world knows: names below them, `left/…`, are accepted too.
    """

    cell: str
    by_kind: Mapping[CellNameKind, frozenset[str]]
    undescribed: frozenset[str] = frozenset()
    joints: Mapping[str, tuple[tuple[float, float], ...]] = field(
        default_factory=dict[str, "tuple[tuple[float, float], ...]"]
    )
    """Lower and upper position limit of each joint of the described robots, radians."""
    drivers: Mapping[str, Driver] = field(default_factory=dict[str, Driver])
    """The drivers of the devices that are not simulated, by bus namespace: `left`, `left/gripper`."""

    def has(self, kind: CellNameKind, name: str) -> bool:
        """Return whether the cell has, or may have, a name of a kind."""
        owner, slash, _ = name.partition("/")
        return kind not in self.by_kind or name in self.by_kind[kind] or (bool(slash) and owner in self.undescribed)

    def missing(self, kind: CellNameKind, name: str) -> str:
        """Return the message for a name that the cell does not have."""
        owner, _, below = name.partition("/")
        if kind in _OWNED:
            owner, _, below = name.rpartition("/") if kind in _OF_PATHS else (owner, "", below)
            return f"`{owner}` of the cell {self.cell} has no {_word(kind)} `{below}`"
        return f"the cell {self.cell} has no {_word(kind)} `{name}`"

    def advice(self, kind: CellNameKind, name: str, *, more: Iterable[str] = ()) -> str:
        """Return suggestions for a missing name, or its actual kind.

        Args:
            kind: The expected kind.
            name: The missing name.
            more: Additional names besides those of the cell.
        """
        other = next((of for of in _others(kind) if name in self.by_kind.get(of, ())), None)
        if other is not None:
            return f"`{name}` is {'' if other == 'equipment' else 'a '}{_word(other)}"
        known = {*self.by_kind.get(kind, ()), *more}
        if kind in _OWNED:
            owner, _, below = name.rpartition("/") if kind in _OF_PATHS else name.partition("/")
            return did_you_mean(below, {each[len(owner) + 1 :] for each in known if each.startswith(f"{owner}/")})
        return did_you_mean(name, known)

    @staticmethod
    def may_come(kind: CellNameKind, name: str) -> bool:
        """Return whether a name may be added while the cell is open; links of arms are never added."""
        return kind in _GROWING and "/" not in name

    def beyond_driver(self, kind: CellNameKind, name: str, skills: Skills) -> str:
        """Return why the driver of a robot, or of its tool of this kind, cannot perform skills; empty if it can."""
        driver = self.drivers.get(name if kind in _OWN_SKILLS else f"{name}/{kind}")
        if driver is None:
            return ""
        # Skills of a tool are those of another device than the arm that carries it.
        own = (skill for skill in skills if _performs(kind, skill.capability))
        return next((reason for skill in own if (reason := driver.lacks_for_skill(skill.skill_name()))), "")

    def listed(self) -> dict[CellNameKind, tuple[str, ...]]:
        """Return the sorted names of every known kind."""
        return {kind: tuple(sorted(names)) for kind, names in self.by_kind.items()}


def _performs(kind: CellNameKind, capability: str | None) -> bool:
    """Return whether a device that a name of this kind means performs skills that need this capability."""
    return kind == capability if capability in _TOOLS else kind in _OWN_SKILLS


_OWN_SKILLS: Final = ("robot", "controller")
"""Kinds of names of devices that perform the skills of a state themselves."""
_TOOLS: Final = ("gripper", "hand")
"""Capabilities of tools, each with the name of its kind of tool."""
_OTHERS: Mapping[CellNameKind, tuple[CellNameKind, ...]] = {
    "robot": ("equipment", "person", "part", "camera"),
    "controller": ("person", "part", "camera"),
    "detector": ("camera",),
    "arm_frame": ("part", "link"),
    "part": ("obstacle",),
    "changeable_tool": ("part",),
    "tool_changer": ("robot",),
}
"""Other kinds that a misused name may have, the most likely first."""


def _others(kind: CellNameKind) -> tuple[CellNameKind, ...]:
    tools = tuple(tool_kinds())
    return (*(tool for tool in tools if tool != kind), "robot") if kind in tools else _OTHERS.get(kind, ())


def _word(kind: CellNameKind) -> str:
    return f"robot with a {kind}" if kind in tool_kinds() else _WORDS.get(kind, kind)


def is_kind(found: object) -> CellNameKind | None:
    """Return the kind of name given in a JSON Schema, None when the value is not a kind."""
    return found if isinstance(found, str) and (found in _KINDS or found in tool_kinds()) else None


def all_kinds() -> tuple[CellNameKind, ...]:
    """Return all kinds of names, those of tools among them."""
    return (*sorted(_KINDS), *sorted(tool_kinds()))


def cell_names(cell: Cell) -> CellNames:
    """Return the names that a cell offers."""
    document = cell.document
    models, kinds = robot_models(), tuple(tool_kinds())
    robots = document.robots
    summaries = {name: _summary(models, cell, name) for name in robots}
    links = frozenset(_links(summaries))
    parts, fixtures, people = (frozenset(each) for each in (document.parts, document.fixtures, document.people))
    frames = frozenset(document.frames)
    # The world shows where the fixtures of a device are; an arm accepts no pose in what moves.
    moved = frozenset(body for device in document.devices.values() for body in device.moved_fixtures)
    detectors = {name: camera.detect for name, camera in document.cameras.items() if camera.detect is not None}
    bases = {f"{name}/{summary.base_link}" for name, summary in summaries.items() if summary is not None}
    tools = {name: _tools(robots[name], summaries[name], kinds) for name in robots}
    found: dict[CellNameKind, frozenset[str]] = {
        "robot": frozenset(robots),
        "link": links,
        "equipment": frozenset(document.equipment),
        "controller": frozenset((*robots, *document.equipment)),
        "output": frozenset((*_outputs(robots, summaries), *_pins(cell, lambda pins: pins.outputs))),
        "input": frozenset((*_inputs(robots, summaries), *_pins(cell, lambda pins: pins.inputs))),
        "pwm_output": frozenset(_pins(cell, lambda pins: pins.pwm_outputs)),
        "part": parts,
        "person": people,
        "camera": frozenset(document.cameras),
        "topic": frozenset(document.topics),
        "detector": frozenset(detectors),
        "label": frozenset(
            f"{name}/{detector.labels.get(part, part)}" for name, detector in detectors.items() for part in parts
        ),
        "frame": links | parts | frames | moved | {_WORLD},
        "arm_frame": frames | {_WORLD, *bases},
        "body": links | parts | fixtures | frozenset(robots) | {_OCCUPANCY},
        "obstacle": fixtures,
        "scene_part": parts,
        "tool_changer": frozenset(name for name, robot in robots.items() if robot.tool_changer is not None),
        "changeable_tool": frozenset(name for name, part in document.parts.items() if part.tool is not None),
        "device": frozenset(document.devices),
        "position": frozenset(
            f"{name}/{position}" for name, device in document.devices.items() for position in device.positions
        ),
        "hexapod_pose": frozenset(
            f"{name}/{pose}"
            for name, device in document.devices.items()
            for pose in (device.hexapod.poses if device.hexapod is not None else ())
        ),
        "unit_place": frozenset(
            f"{name}/{place}"
            for name, device in document.devices.items()
            for place in (device.linear_unit.places if device.linear_unit is not None else ())
        ),
        "tool_point": frozenset(
            f"{name}/{point}"
            for name, part in document.parts.items()
            if part.tool is not None
            for point in part.tool.tcps
        ),
        "module": frozenset(document.modules),
        "connector": frozenset(document.connectors),
    }
    if kinds:
        found["tool"] = frozenset(f"{name}/{kind}" for name, possible in tools.items() for kind in possible)
    for kind in kinds:
        found[kind] = frozenset(name for name, possible in tools.items() if kind in possible)
    if models is not None:
        found["planner"] = frozenset(models.planners())
    undescribed = frozenset(name for name, summary in summaries.items() if summary is None)
    undescribed |= {name for name in document.equipment if name not in cell.pins}
    joints = {name: summary.joints for name, summary in summaries.items() if summary is not None}
    return CellNames(
        cell=cell.name, by_kind=found, undescribed=undescribed | people, joints=joints, drivers=_drivers(cell)
    )


def _drivers(cell: Cell) -> dict[str, Driver]:
    if not cell.document.real_devices:
        return {}  # drivers are looked up only where one is named: that takes 20 ms
    found: dict[str, Driver] = {}
    for assigned in assigned_drivers(cell):
        try:
            driver = assigned.driver()
        except FlexcellError:
            continue  # the check of the cell reports the error
        name = assigned.device_name(driver)
        found[name] = driver
        with suppress(FlexcellError):  # as above, of an option
            found[name] = driver.configured(assigned.options(driver))
    return found


def _summary(models: RobotModels | None, cell: Cell, robot: str) -> RobotSummary | None:
    try:
        return models.summary(cell, robot) if models is not None else None
    except FlexcellError:
        return None  # the check of the cell reports the error


def _links(summaries: Mapping[str, RobotSummary | None]) -> Iterator[str]:
    for name, summary in summaries.items():
        if summary is not None:
            yield from (f"{name}/{link}" for link in summary.links)


def _tools(robot: RobotSpec, summary: RobotSummary | None, kinds: tuple[str, ...]) -> tuple[str, ...]:
    """Return the possible tools of a robot: any when its model is unknown, or when its driver may add one."""
    if summary is None or (summary.tool is None and not robot.simulated):
        return kinds if robot.gripper is not None or not robot.simulated else ()
    return (summary.tool,) if summary.tool is not None else ()


def _outputs(robots: Mapping[str, RobotSpec], summaries: Mapping[str, RobotSummary | None]) -> Iterator[str]:
    for name, robot in robots.items():
        summary = summaries[name]
        yield from (f"{name}/{use}" for use in robot.outputs)
        yield from (f"{name}/{number}" for number in range(summary.digital_outputs if summary is not None else 0))


def _inputs(robots: Mapping[str, RobotSpec], summaries: Mapping[str, RobotSummary | None]) -> Iterator[str]:
    for name, robot in robots.items():
        summary = summaries[name]
        yield from (f"{name}/{each}" for each in robot.inputs)
        yield from (f"{name}/{number}" for number in range(summary.digital_inputs if summary is not None else 0))


def _pins(cell: Cell, of: Callable[[EquipmentDocument], Iterable[str]]) -> Iterator[str]:
    """Yield pins of the equipment by name: their numbers change with the configuration."""
    for name, equipment in cell.pins.items():
        yield from (f"{name}/{pin}" for pin in of(equipment.document))
