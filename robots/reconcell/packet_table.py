"""All ports of the interface: appendices A and B of the ReconCell interfaces as one table.

Where the appendix contradicts itself a port takes more than one layout; docs/decisions/0089 lists each case.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from robots.reconcell.packets import (
    JOINTS,
    KERNELS,
    OFFSET_CENTERS,
    DirectFlags,
    DirectJoints,
    DmpExecution,
    DmpFlags,
    DmpHeader,
    KernelRow,
    LineGoal,
    ModeSelection,
    OutputBits,
    Packet,
    PhaseHold,
    RobotFlags,
    RobotStatePacket,
    ToolParameters,
    TrajectoryFlags,
    TrapezoidGoal,
)

Direction = Literal["command", "state"]
Family = Literal["", "cart_dmp", "joint_dmp", "offset", "force"]
NumberKind = Literal["double", "uint8"]

_CODES: Mapping[NumberKind, str] = {"double": "d", "uint8": "B"}


@dataclass(frozen=True)
class PacketField:
    """`count` numbers of one kind; one of them is a number in the struct, more are a tuple."""

    name: str
    kind: NumberKind
    count: int = 1


@dataclass(frozen=True)
class PacketLayout:
    """The fields of a packet in order, without gaps, little-endian."""

    fields: tuple[PacketField, ...]

    @property
    def format(self) -> struct.Struct:
        """The packet for `struct`."""
        return struct.Struct("<" + "".join(f"{each.count}{_CODES[each.kind]}" for each in self.fields))

    @property
    def size(self) -> int:
        """Bytes of the packet."""
        return self.format.size


@dataclass(frozen=True, kw_only=True)
class PacketSpec:
    """What a port carries.

    Attributes:
        port: UDP port.
        direction: `command` for those that the server receives, `state` for those that it sends.
        title: Its heading in the appendix, where that is right.
        packet: The struct of it.
        layouts: The layouts that are accepted; the first one is sent.
        printed_size: The size that the appendix prints.
        family: The parameters that it is a part of.
        row: Its row among them, such as `c` or `w3`.
    """

    port: int
    direction: Direction
    title: str
    packet: type[Packet]
    layouts: tuple[PacketLayout, ...]
    printed_size: int
    family: Family = ""
    row: str = ""


def specs_of(port: int, direction: Direction) -> tuple[PacketSpec, ...]:
    """Return what a port carries; empty for a port that is none of the interface."""
    return _BY_PORT.get((direction, port), ())


def command_ports() -> tuple[int, ...]:
    """Return all ports on which the server receives."""
    return _ports("command")


def state_ports() -> tuple[int, ...]:
    """Return all ports to which the server sends."""
    return _ports("state")


def port_table() -> str:
    """Return the table of all ports as Markdown, for the documentation."""
    lines = ["| port | direction | content | bytes | printed in the appendix |", "|---|---|---|---|---|"]
    for spec in SPECS:
        contents = " or ".join(_content(layout) for layout in spec.layouts)
        sizes = " or ".join(str(layout.size) for layout in spec.layouts)
        direction = "to the server" if spec.direction == "command" else "from the server"
        lines.append(f"| {spec.port} | {direction} | {spec.title}: {contents} | {sizes} | {spec.printed_size} |")
    return "\n".join(lines) + "\n"


def _content(layout: PacketLayout) -> str:
    return ", ".join(f"`{f.name}` {f.kind}{f' x {f.count}' if f.count > 1 else ''}" for f in layout.fields)


def _layout(*fields: PacketField) -> PacketLayout:
    return PacketLayout(fields)


def _double(name: str, count: int = 1) -> PacketField:
    return PacketField(name, "double", count)


def _byte(name: str) -> PacketField:
    return PacketField(name, "uint8")


def _header(components: int) -> PacketLayout:
    scalars = (_double(name) for name in ("kernels", "a_z", "a_x", "tau"))
    return _layout(*scalars, _double("goal", components), _double("y0", components), _double("dy0", JOINTS))


def _row(count: int = KERNELS) -> PacketLayout:
    return _layout(_double("values", count))


def _command(
    port: int, title: str, packet: type[Packet], *layouts: PacketLayout, printed: int | None = None
) -> PacketSpec:
    size = layouts[0].size if printed is None else printed
    return PacketSpec(port=port, direction="command", title=title, packet=packet, layouts=layouts, printed_size=size)


def _state(port: int, title: str, packet: type[Packet], *fields: PacketField) -> PacketSpec:
    layout = _layout(*fields)
    return PacketSpec(
        port=port, direction="state", title=title, packet=packet, layouts=(layout,), printed_size=layout.size
    )


def _rows(port: int, title: str, family: Family, weights: int) -> Iterable[PacketSpec]:
    for number, row in enumerate(("c", "sigma", *(f"w{index}" for index in range(1, weights + 1)))):
        # The centres of the offsets are 100 in the appendix, their variances and weights 184.
        short = family == "offset" and row == "c"
        layouts = (_row(OFFSET_CENTERS), _row()) if short else (_row(),)
        yield PacketSpec(
            port=port + number,
            direction="command",
            title=f"{title}, {row}",
            packet=KernelRow,
            layouts=layouts,
            printed_size=layouts[0].size,
            family=family,
            row=row,
        )


def _primitive(port: int, title: str, family: Family, components: int, *, stopping_size: int) -> Iterable[PacketSpec]:
    doubles = _layout(_double("execute"), _double("reset"))
    bytes_ = _layout(_byte("execute"), _byte("reset"))
    stopping = (_layout(_byte("stopped")), _layout(_double("stopped")))
    rows = _rows(port + 1, f"{title} parameters", family, JOINTS)
    header = _command(port, f"{title} parameters", DmpHeader, _header(components))
    flags = _command(port + 9, f"{title} execution flags", DmpExecution, doubles, bytes_, printed=16)
    phase = _command(
        port + 10,
        f"{title} phase stopping flag",
        PhaseHold,
        *(stopping if stopping_size == 1 else stopping[::-1]),
        printed=stopping_size,
    )
    for spec in (header, *rows, flags, phase):
        yield replace(spec, family=family)


_DMP_FLAGS = tuple(_double(name) for name in ("received", "loaded_id", "execute", "reset", "phase", "finished"))
_ROBOT_FLAGS = ("received_mode", "sent_mode", "idle", "error", "running", "received", "finished")

SPECS: tuple[PacketSpec, ...] = (
    _command(10000, "Mode selection", ModeSelection, _layout(_byte("mode"))),
    _command(11000, "Desired digital outputs", OutputBits, _layout(_double("value"))),
    _command(
        12000,
        "End effector tool data",
        ToolParameters,
        _layout(
            _double("xyz_m", 3),
            _double("orientation", 4),
            _double("com_m", 3),
            _double("mass_kg"),
            _double("force_offset_n", 3),
            _double("torque_offset_nm", 3),
        ),
        printed=8,
    ),
    _state(
        15000,
        "Robot general states",
        RobotStatePacket,
        _double("joints", JOINTS),
        _double("desired_joints", JOINTS),
        _double("velocity_rad_s", JOINTS),
        _double("desired_velocity_rad_s", JOINTS),
        _double("position_m", 3),
        _double("orientation", 4),
        _double("sensor_wrench", 6),
        _double("tool_wrench", 6),
        _double("outputs"),
        _double("inputs"),
    ),
    _state(15001, "Robot general flags", RobotFlags, *(_byte(name) for name in _ROBOT_FLAGS)),
    _state(15002, "Joint direct control flags", DirectFlags, _byte("received")),
    _state(15003, "Joint trapezoidal flags", TrajectoryFlags, _byte("received"), _byte("finished")),
    _state(15004, "Cartesian minimum jerk flags", TrajectoryFlags, _byte("received"), _byte("finished")),
    _state(15005, "Cartesian DMP flags", DmpFlags, *_DMP_FLAGS),
    _state(15006, "Joint space DMP flags", DmpFlags, *_DMP_FLAGS),
    _command(20000, "Joint direct control", DirectJoints, _layout(_double("joints", JOINTS))),
    *_primitive(25000, "Cartesian DMP", "cart_dmp", JOINTS + 1, stopping_size=1),
    *_primitive(25100, "Joint space DMP", "joint_dmp", JOINTS, stopping_size=8),
    _command(
        26000, "Joint trapezoidal speed profile", TrapezoidGoal, _layout(_double("joints", JOINTS), _double("speed"))
    ),
    _command(
        27000,
        "Cartesian minimum jerk line",
        LineGoal,
        _layout(_double("position_m", 3), _double("orientation", 4), _double("duration_s")),
    ),
    *_rows(27000, "Adaptation offset", "offset", 7),
    *_rows(28000, "Reference force and torque profile", "force", JOINTS),
)


def _ports(direction: Direction) -> tuple[int, ...]:
    return tuple(sorted(port for known, port in _BY_PORT if known == direction))


def _by_port() -> Mapping[tuple[Direction, int], tuple[PacketSpec, ...]]:
    found: dict[tuple[Direction, int], tuple[PacketSpec, ...]] = {}
    for spec in SPECS:
        found[spec.direction, spec.port] = (*found.get((spec.direction, spec.port), ()), spec)
    return found


_BY_PORT = _by_port()
