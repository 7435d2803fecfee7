"""From bytes to packets and back, by the table of ports."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

from robots.reconcell.packet_errors import PacketRefused
from robots.reconcell.packet_table import Direction, PacketLayout, PacketSpec, specs_of
from robots.reconcell.packets import Packet


def decode_packet(port: int, data: bytes, *, direction: Direction = "command") -> tuple[PacketSpec, Packet]:
    """Return what a datagram on a port says.

    Raises:
        PacketRefused: the port is not known, the size is none of this port, or a value is none that can be.
    """
    specs = specs_of(port, direction)
    if not specs:
        raise PacketRefused("wrong port", f"{port} is no port of this direction")
    for spec in specs:
        for layout in spec.layouts:
            if layout.size == len(data):
                return spec, _decode(spec, layout, data)
    sizes = sorted({layout.size for spec in specs for layout in spec.layouts})
    raise PacketRefused(
        "wrong size",
        f"{len(data)} bytes",
        where=f"port {port}",
        hint=f"{specs[0].title} has {' or '.join(map(str, sizes))} bytes",
    )


def encode_packet(packet: Packet, port: int, *, direction: Direction = "command", size: int | None = None) -> bytes:
    """Return a packet as a datagram to a port, in the first layout of it, or that of `size` bytes.

    Raises:
        PacketRefused: the port carries no such packet, or one of its rows has another length.
    """
    for spec in specs_of(port, direction):
        for layout in spec.layouts:
            if isinstance(packet, spec.packet) and size in {None, layout.size} and _fits(packet, layout):
                return _compiled(layout).pack(*_numbers(packet, layout))
    raise PacketRefused("wrong size", f"port {port} carries no {type(packet).__name__} of these lengths")


def _decode(spec: PacketSpec, layout: PacketLayout, data: bytes) -> Packet:
    numbers = _compiled(layout).unpack(data)
    where = f"port {spec.port}"
    if not all(map(math.isfinite, numbers)):
        raise PacketRefused("not finite", f"{spec.title} has a value that is no finite number", where=where)
    values: dict[str, Any] = {}
    place = 0
    for each in layout.fields:
        row = numbers[place : place + each.count]
        values[each.name] = row[0] if each.count == 1 else row
        place += each.count
    try:
        return spec.packet(**values)
    except ValueError as error:
        raise PacketRefused("out of range", str(error), where=where) from error


def _fits(packet: Packet, layout: PacketLayout) -> bool:
    return all(len(_row(packet, each.name)) == each.count for each in layout.fields)


def _numbers(packet: Packet, layout: PacketLayout) -> list[float]:
    return [
        int(value) if each.kind == "uint8" else float(value)
        for each in layout.fields
        for value in _row(packet, each.name)
    ]


def _row(packet: Packet, name: str) -> tuple[float, ...]:
    value: float | tuple[float, ...] = getattr(packet, name)
    return value if isinstance(value, tuple) else (value,)


@cache
def _compiled(layout: PacketLayout) -> Any:
    return layout.format
