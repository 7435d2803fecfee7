"""The packets are those of the appendices, byte for byte, and survive a round trip."""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.reconcell.control_mode import ControlMode
from robots.reconcell.packet_codec import decode_packet, encode_packet
from robots.reconcell.packet_errors import PacketRefused
from robots.reconcell.packet_table import (
    SPECS,
    Direction,
    PacketLayout,
    PacketSpec,
    command_ports,
    port_table,
    specs_of,
)
from robots.reconcell.packets import (
    DmpExecution,
    DmpHeader,
    LineGoal,
    ModeSelection,
    OutputBits,
    PhaseHold,
    ToolParameters,
    TrapezoidGoal,
)
from tests.robots.reconcell.write_golden_packets import golden

ROOT = Path(__file__).resolve().parents[3]
LINES = Path(__file__).with_name("golden_packets.txt").read_text(encoding="ascii").splitlines()[1:]
DIRECTIONS: dict[str, Direction] = {">": "command", "<": "state"}
GOLDEN = [
    (DIRECTIONS[sign], int(port), bytes.fromhex(text)) for sign, port, text in (line.split(" ") for line in LINES)
]
FINITE = st.floats(allow_nan=False, allow_infinity=False)
FLAG = st.sampled_from([0.0, 1.0])
POSITIVE = st.floats(1e-6, 1e6)
SIZES = {
    10000: {1}, 11000: {8}, 12000: {136}, 20000: {48}, 25000: {192}, 25009: {16, 2}, 25010: {1, 8}, 25100: {176},
    25109: {16, 2}, 25110: {8, 1}, 26000: {56}, 27000: {64, 800, 1472},
    15000: {360}, 15001: {7}, 15002: {1}, 15003: {2}, 15004: {2}, 15005: {48}, 15006: {48},
    **{port: {1472} for base in (25001, 25101, 27001, 28000) for port in range(base, base + 8)},
}  # fmt: skip
"""Typed from the appendices; where it contradicts itself, as docs/decisions/0089 says."""


def test_the_committed_packets_are_those_made_by_hand() -> None:
    by_hand = [(DIRECTIONS[sign], port, data) for sign, port, data in golden()]
    assert by_hand == GOLDEN


def test_ports_and_sizes_are_those_of_the_appendices() -> None:
    found: dict[int, set[int]] = {}
    for spec in SPECS:
        found.setdefault(spec.port, set()).update(layout.size for layout in spec.layouts)
    assert found == SIZES
    assert len(command_ports()) == 44


@pytest.mark.parametrize(("direction", "port", "data"), GOLDEN)
def test_a_packet_is_read_and_written_again(direction: Direction, port: int, data: bytes) -> None:
    spec, packet = decode_packet(port, data, direction=direction)
    assert encode_packet(packet, port, direction=direction, size=len(data)) == data
    assert spec.port == port
    with pytest.raises(PacketRefused, match="wrong size"):
        decode_packet(port, data + b"\0", direction=direction)


def test_every_layout_has_a_committed_packet() -> None:
    written = {(direction, port, len(data)) for direction, port, data in GOLDEN}
    assert written == {(spec.direction, spec.port, layout.size) for spec in SPECS for layout in spec.layouts}


def test_values_are_where_the_appendix_has_them() -> None:
    """Decoded by name, from bytes that name nothing."""
    line = struct.pack("<8d", 0.4, -0.2, 0.6, 0.0, 0.0, 0.0, 1.0, 2.5)
    assert decode_packet(27000, line)[1] == LineGoal(
        position_m=(0.4, -0.2, 0.6), orientation=(0.0, 0.0, 0.0, 1.0), duration_s=2.5
    )
    tool = struct.pack("<17d", 1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0)
    assert decode_packet(12000, tool)[1] == ToolParameters(
        xyz_m=(1.0, 2.0, 3.0),
        orientation=(0.0, 0.0, 0.0, 1.0),
        com_m=(4.0, 5.0, 6.0),
        mass_kg=7.0,
        force_offset_n=(8.0, 9.0, 10.0),
        torque_offset_nm=(11.0, 12.0, 13.0),
    )
    header = struct.pack("<22d", 20.0, 48.0, 2.0, 3.0, *range(6), *range(6, 12), *range(12, 18))
    assert decode_packet(25100, header)[1] == DmpHeader(
        kernels=20.0,
        a_z=48.0,
        a_x=2.0,
        tau=3.0,
        goal=tuple(map(float, range(6))),
        y0=tuple(map(float, range(6, 12))),
        dy0=tuple(map(float, range(12, 18))),
    )
    assert decode_packet(25009, bytes([0, 1]))[1] == DmpExecution(execute=0, reset=1)
    assert decode_packet(25009, struct.pack("<2d", 1.0, 0.0))[1] == DmpExecution(execute=1, reset=0)


@pytest.mark.parametrize("data", [bytes([1, 0] + [0] * 14), bytes([1] + [0] * 15), struct.pack("<2d", 0.5, 0.0)])
def test_sixteen_bytes_that_are_no_two_doubles_are_no_flags(data: bytes) -> None:
    """Two bytes that are filled up to 16 would be two tiny doubles."""
    with pytest.raises(PacketRefused, match="out of range"):
        decode_packet(25009, data)


def test_27000_is_a_line_or_offsets_by_its_size() -> None:
    titles = {size: decode_packet(27000, next(d for _, p, d in GOLDEN if (p, len(d)) == (27000, size)))[0].title
              for size in (64, 800, 1472)}  # fmt: skip
    assert titles == {
        64: "Cartesian minimum jerk line",
        800: "Adaptation offset, c",
        1472: "Adaptation offset, c",
    }


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_double_that_is_no_number_is_refused_at_each_place(value: float) -> None:
    for spec in SPECS:
        for layout in spec.layouts:
            if spec.direction == "command" and layout.fields[0].kind == "double":
                data = struct.pack(f"<{layout.size // 8}d", *[1.0] * (layout.size // 8 - 1), value)
                with pytest.raises(PacketRefused, match="not finite"):
                    decode_packet(spec.port, data)


def _values(spec: PacketSpec, layout: PacketLayout) -> st.SearchStrategy[dict[str, Any]]:
    def numbers(name: str, kind: str, count: int) -> st.SearchStrategy[Any]:
        if spec.packet is ModeSelection:
            return st.sampled_from([int(mode) for mode in ControlMode])
        if spec.packet in {DmpExecution, PhaseHold}:
            return FLAG
        if spec.packet is OutputBits:
            return st.integers(0, 2**53 - 1).map(float)
        if name == "kernels":
            return st.integers(1, 184).map(float)
        if name == "orientation" or (spec.packet is DmpHeader and count == 7):
            rest = st.tuples(*[FINITE] * (count - 4))
            return rest.map(lambda values: (*values, 0.5, -0.5, 0.5, 0.5))
        if name == "speed":
            return st.floats(1e-6, 1.0)
        if name in {"a_z", "a_x", "tau", "duration_s", "mass_kg"}:
            return POSITIVE
        one = st.integers(0, 255) if kind == "uint8" else FINITE
        return one if count == 1 else st.tuples(*[one] * count)

    return st.fixed_dictionaries({each.name: numbers(each.name, each.kind, each.count) for each in layout.fields})


@given(st.data())
def test_a_packet_survives_its_bytes(data: st.DataObject) -> None:
    spec = data.draw(st.sampled_from(SPECS))
    layout = data.draw(st.sampled_from(spec.layouts))
    packet = spec.packet(**data.draw(_values(spec, layout)))
    sent = encode_packet(packet, spec.port, direction=spec.direction, size=layout.size)
    assert len(sent) == layout.size
    assert decode_packet(spec.port, sent, direction=spec.direction)[1] == packet


def test_what_cannot_be_is_not_made() -> None:
    with pytest.raises(ValueError, match="the speed is 0"):
        TrapezoidGoal(joints=(0.0,) * 6, speed=0.0)
    with pytest.raises(PacketRefused, match="99 is no mode"):
        ModeSelection(mode=99)
    with pytest.raises(PacketRefused, match="carries no"):
        encode_packet(TrapezoidGoal(joints=(0.0,) * 7, speed=1.0), 26000)
    assert specs_of(15000, "command") == ()


def test_the_reference_has_the_table_of_the_code() -> None:
    text = (ROOT / "docs" / "reference" / "reconcell-ports.md").read_text(encoding="utf-8")
    assert port_table() in text
