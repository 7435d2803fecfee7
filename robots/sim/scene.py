"""What a simulated cell consists of, as plain data that can cross a process border.

All poses are in the world frame; sizes are metres. `box` has full edge lengths, `cylinder`
(diameter, length along z); a `tray` has outer edge lengths and
its pose is the centre of its bottom face, every other pose is the centre of the body.
"""

from __future__ import annotations

import msgspec

from engine.messages import Pose

Rgba = tuple[float, float, float, float]
GREY: Rgba = (0.7, 0.7, 0.7, 1.0)


class ArmPlacement(msgspec.Struct, frozen=True, kw_only=True):
    """One arm: its name in the cell, its robot model's name, where its base stands."""

    name: str
    model: str
    base: Pose


class FixtureBody(msgspec.Struct, frozen=True, kw_only=True):
    """A body that never moves; `wall_m` is the thickness of a tray's floor and walls."""

    name: str
    shape: str
    size_m: tuple[float, ...]
    pose: Pose
    wall_m: float = 0.005
    rgba: Rgba = GREY


class PartBody(msgspec.Struct, frozen=True, kw_only=True):
    """A free body with uniform density."""

    name: str
    shape: str
    size_m: tuple[float, ...]
    mass_kg: float
    pose: Pose
    rgba: Rgba = GREY


class Scene(msgspec.Struct, frozen=True, kw_only=True):
    """Everything that a simulated world is built from; equal scenes give equal worlds, bit for bit."""

    step_s: float = 0.001
    gravity: bool = True
    arms: tuple[ArmPlacement, ...] = ()
    fixtures: tuple[FixtureBody, ...] = ()
    parts: tuple[PartBody, ...] = ()
