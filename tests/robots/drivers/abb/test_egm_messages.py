"""The packets of Externally Guided Motion: golden bytes of protobuf, both directions, and any other bytes."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.drivers.abb.abb_faults import AbbFault, AbbLinkError
from robots.drivers.abb.egm.egm_messages import (
    EgmMeasurement,
    EgmSetPoint,
    MciState,
    MotorState,
    RapidState,
    decode_measurement,
    decode_set_point,
    encode_measurement,
    encode_set_point,
    renumber_measurement,
)
from tests.tiers import examples

MANY = settings(max_examples=examples(200, nightly=5_000), deadline=None)
UINT32 = st.integers(0, 2**32 - 1)
SIX = st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 6)
MEASUREMENTS = st.builds(
    EgmMeasurement,
    number=UINT32,
    time_ms=UINT32,
    measured_deg=SIX,
    planned_deg=st.none() | SIX,
    motors=st.sampled_from(MotorState),
    mci=st.sampled_from(MciState),
    rapid=st.sampled_from(RapidState),
)
SET_POINTS = st.builds(EgmSetPoint, number=UINT32, time_ms=UINT32, planned_deg=SIX)
# What the protobuf library of Google writes for an EgmSensor with the header 300, 70000, MSGTYPE_CORRECTION and the
# joints 1, -2, 0, 0.5, 0, 180.
GOLDEN = bytes.fromhex(
    "0a0908ac0210f0a204180312380a3609000000000000f03f0900000000000000c0090000000000000000"
    "09000000000000e03f0900000000000000000900000000008066 40".replace(" ", "")
)


def test_a_set_point_has_the_bytes_of_protobuf() -> None:
    set_point = EgmSetPoint(number=300, time_ms=70000, planned_deg=(1.0, -2.0, 0.0, 0.5, 0.0, 180.0))
    assert encode_set_point(set_point) == GOLDEN
    assert decode_set_point(GOLDEN) == set_point


@MANY
@given(MEASUREMENTS)
def test_a_measurement_is_read_as_it_was_written(measurement: EgmMeasurement) -> None:
    assert decode_measurement(encode_measurement(measurement)) == measurement


@MANY
@given(MEASUREMENTS, st.integers(0, 1000))
def test_a_measurement_is_numbered_on_and_nothing_else_changes(measurement: EgmMeasurement, by: int) -> None:
    packet = encode_measurement(measurement)
    later = replace(
        measurement,
        number=(measurement.number + by) % 2**32,
        time_ms=(measurement.time_ms + 4 * by) % 2**32,
    )
    assert decode_measurement(renumber_measurement(packet, by=by, time_ms=4 * by)) == later
    with pytest.raises(AbbLinkError):
        renumber_measurement(packet[:9], by=by, time_ms=0)


@MANY
@given(SET_POINTS)
def test_a_set_point_is_read_as_it_was_written(set_point: EgmSetPoint) -> None:
    assert decode_set_point(encode_set_point(set_point)) == set_point


@MANY
@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(packet: bytes) -> None:
    with suppress(AbbLinkError):
        decode_measurement(packet)
    with suppress(AbbLinkError):
        decode_set_point(packet)


@MANY
@given(MEASUREMENTS, st.integers(0, 400), st.integers(0, 255))
def test_a_spoilt_byte_gives_a_measurement_of_finite_angles_or_garbage(
    measurement: EgmMeasurement, at: int, byte: int
) -> None:
    packet = bytearray(encode_measurement(measurement))
    packet[at % len(packet)] = byte
    with suppress(AbbLinkError):
        assert len(decode_measurement(bytes(packet)).measured_deg) == 6


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_value_that_is_not_finite_is_neither_sent_nor_taken(value: float) -> None:
    with pytest.raises(ValueError, match="is no set point"):
        encode_set_point(EgmSetPoint(number=1, time_ms=1, planned_deg=(value, *(0.0,) * 5)))
    spoilt = encode_measurement(EgmMeasurement(number=1, time_ms=1, measured_deg=(value, *(0.0,) * 5)))
    with pytest.raises(AbbLinkError, match="not finite") as refused:
        decode_measurement(spoilt)
    assert refused.value.fault is AbbFault.GARBAGE


def test_packed_angles_are_read_too() -> None:
    """Protobuf allows both forms of repeated numbers."""
    joints = bytes.fromhex("0a30") + bytes(48)
    packet = bytes.fromhex("0a0408011002") + bytes([0x12, len(joints) + 2, 0x0A, len(joints)]) + joints
    assert decode_measurement(packet).measured_deg == (0.0,) * 6
