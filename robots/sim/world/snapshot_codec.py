"""The snapshot of a world as bytes: its contents, and the checks that detect damage and mix-ups."""

from __future__ import annotations

import hashlib
from typing import TypeVar

import msgspec
import numpy as np

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.port import Array, GraspCommand
from robots.sim.physics.physics import mujoco

FORMAT = 2
"""Raised whenever the meaning of the bytes changes."""

S = TypeVar("S", bound=msgspec.Struct)

_NUMBER = np.dtype("<f8")


class WorldImage(msgspec.Struct, frozen=True, kw_only=True):
    """A world at one instant.

    Its numbers as in `ImageLayout`, the grasp command of each gripper, the settings of each arm, the reasons of active
    reflexes, and the digital outputs and inputs of arms that have some. `memos` are the saved states of devices, by
    their names, in their own encoding.
    """

    numbers: bytes
    grips: dict[str, GraspCommand]
    settings: dict[str, ControlSettings]
    reflexes: dict[str, str]
    outputs: dict[str, tuple[bool, ...]]
    memos: dict[str, bytes] = {}
    inputs: dict[str, tuple[bool, ...]] = {}

    @classmethod
    def of(
        cls,
        numbers: Array,
        grips: dict[str, GraspCommand],
        settings: dict[str, ControlSettings],
        reflexes: dict[str, str],
        outputs: dict[str, tuple[bool, ...]],
        memos: dict[str, bytes] | None = None,
        inputs: dict[str, tuple[bool, ...]] | None = None,
    ) -> WorldImage:
        """Return the image with these numbers."""
        data, memos = numbers.astype(_NUMBER, copy=False).tobytes(), memos or {}
        return cls(
            numbers=data, grips=grips, settings=settings, reflexes=reflexes, outputs=outputs, memos=memos,
            inputs=inputs or {},
        )  # fmt: skip

    def array(self) -> Array:
        """Return the numbers."""
        return np.frombuffer(self.numbers, dtype=_NUMBER).astype(np.float64)


class _FormatHeader(msgspec.Struct, frozen=True, kw_only=True):
    """The header common to all formats."""

    flexcell_world: int


class _SnapshotFile(_FormatHeader, frozen=True, kw_only=True):
    simulator: str
    model: str
    digest: bytes
    content: bytes


def encode_snapshot(image: WorldImage, *, model: str) -> bytes:
    """Return the snapshot of a world whose compiled model has the fingerprint `model`."""
    content = msgspec.msgpack.encode(image)
    return msgspec.msgpack.encode(
        _SnapshotFile(
            flexcell_world=FORMAT,
            simulator=_simulator(),
            model=model,
            digest=hashlib.sha256(content).digest(),
            content=content,
        )
    )


def decode_snapshot(snapshot: bytes, *, model: str, size: int) -> WorldImage:
    """Return the image in a snapshot of this world; it has `size` numbers.

    Raises:
        RobotError: not a snapshot, damaged, from another version, or of another world.
    """
    label = _decoded(snapshot, _FormatHeader)
    if label.flexcell_world != FORMAT:
        raise RobotError(
            f"the snapshot has format {label.flexcell_world}, this version reads {FORMAT}",
            hint="continue with the version that made it",
        )
    seal = _decoded(snapshot, _SnapshotFile)
    if hashlib.sha256(seal.content).digest() != seal.digest:
        raise RobotError("the snapshot of the world is damaged", hint="start again from the beginning")
    if seal.simulator != _simulator():
        raise RobotError(
            f"the snapshot was made with {seal.simulator}, this is {_simulator()}",
            hint="continue with the simulator that made it",
        )
    if seal.model != model:
        raise RobotError(
            "the snapshot is of another world", hint="open the same cell with the same seed as when it was made"
        )
    return _sound(_decoded(seal.content, WorldImage), size)


def _decoded(data: bytes, kind: type[S]) -> S:
    try:
        return msgspec.msgpack.decode(data, type=kind)
    except (msgspec.DecodeError, RecursionError, ValueError) as error:
        raise RobotError("these bytes are not a snapshot of a simulated world") from error


def _simulator() -> str:
    return f"MuJoCo {mujoco.__version__}"


def _sound(image: WorldImage, size: int) -> WorldImage:
    if len(image.numbers) != size * _NUMBER.itemsize or not np.isfinite(image.array()).all():
        raise RobotError("the snapshot contains an invalid world state", hint="start again from the beginning")
    return image
