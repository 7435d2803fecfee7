"""The bytes of a snapshot: what was sealed comes back, and nothing else does."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.port import GraspCommand
from robots.sim.world.snapshot_codec import FORMAT, WorldImage, decode_snapshot, encode_snapshot

NUMBERS = np.arange(40.0) / 3.0
GRIPS = {"left/gripper": GraspCommand(least_m=0.02, most_m=0.04, force_n=20.0)}
SETTINGS = {"left": ControlSettings(controller="cartesian_impedance", load_kg=2.0, collision_force_n=20.0)}
REFLEXES = {"left": "external force limit exceeded: 31.0 N > 20 N at the tool"}
OUTPUTS = {"left": (True, False)}
IMAGE = WorldImage.of(NUMBERS, GRIPS, SETTINGS, REFLEXES, OUTPUTS)
SNAPSHOT = encode_snapshot(IMAGE, model="m")


def refusal(snapshot: bytes, *, model: str = "m", size: int = 40) -> str:
    """Return why a snapshot is refused."""
    with pytest.raises(RobotError) as caught:
        decode_snapshot(snapshot, model=model, size=size)
    return str(caught.value)


def test_what_was_sealed_comes_back() -> None:
    image = decode_snapshot(SNAPSHOT, model="m", size=40)
    assert (image, image.array().tolist()) == (IMAGE, NUMBERS.tolist())


def test_equal_worlds_have_equal_snapshots() -> None:
    again = WorldImage.of(NUMBERS.copy(), dict(GRIPS), dict(SETTINGS), dict(REFLEXES), dict(OUTPUTS))
    assert encode_snapshot(again, model="m") == SNAPSHOT


def test_another_world_is_refused() -> None:
    assert refusal(SNAPSHOT, model="n").startswith("the snapshot is of another world (open the same cell")


def test_another_format_is_refused_whatever_else_it_has() -> None:
    later = msgspec.msgpack.encode({"flexcell_world": FORMAT + 1, "whatever": [1, 2]})
    assert f"format {FORMAT + 1}, this version reads {FORMAT}" in refusal(later)


def test_another_simulator_is_refused() -> None:
    other = msgspec.msgpack.decode(SNAPSHOT)
    other["simulator"] = "MuJoCo 1.50"
    assert "made with MuJoCo 1.50, this is MuJoCo" in refusal(msgspec.msgpack.encode(other))


@pytest.mark.parametrize("numbers", [np.zeros(39), np.full(40, np.nan)])
def test_a_world_that_cannot_be_is_refused(numbers: np.ndarray[tuple[int], np.dtype[np.float64]]) -> None:
    assert "an invalid world state" in refusal(encode_snapshot(WorldImage.of(numbers, {}, {}, {}, {}), model="m"))


@given(st.binary(max_size=400))
def test_garbage_is_refused(garbage: bytes) -> None:
    refusal(garbage)


def test_deeply_nested_garbage_is_refused() -> None:
    refusal(b"\x91" * 100_000)


@given(st.integers(0, len(SNAPSHOT) * 8 - 1))
def test_a_snapshot_with_one_wrong_bit_is_refused(bit: int) -> None:
    damaged = bytearray(SNAPSHOT)
    damaged[bit // 8] ^= 1 << bit % 8
    refusal(bytes(damaged))


@given(st.integers(0, len(SNAPSHOT) - 1))
def test_a_snapshot_that_breaks_off_is_refused(length: int) -> None:
    refusal(SNAPSHOT[:length])
