"""Hexapods of a cell on the bus, each under the name of its device: where its platform is, and where an arm moves it.

An arm that holds the platform moves it while the brakes are released; the brakes are positions of the device.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.messages import Message, Pose
from engine.skill import Service

PoseName = Annotated[str, Meta(min_length=1, description="Name of one of its poses")]


class HexapodReading(Message, frozen=True, kw_only=True):
    """Where the platform is shown, and where it is at the named pose, both in the world; the lengths of the six legs.

    A simulation shows where it is. A real hexapod measures nothing: a camera or the arm that holds it does.
    """

    platform: Pose
    target: Pose
    lengths_m: tuple[float, ...]


class ReadHexapod(Service[HexapodReading], frozen=True, kw_only=True):
    """Return where the platform is, beside one of its named poses; fails for a pose that it does not have."""

    pose: PoseName


class HexapodMove(Message, frozen=True, kw_only=True):
    """How a tool that holds the platform moves it to a pose.

    `refused` says which leg would be beyond which limit, and by how much; empty for none. `platform` and `tool` are
    where both are at the end, in the world. `released` and `locked` are the positions of the device for its brakes.
    `bodies` are the fixtures that move.
    """

    refused: str = ""
    start: Pose
    platform: Pose
    tool: Pose
    released: str
    locked: str
    bodies: tuple[str, ...]


class PlanHexapodMove(Service[HexapodMove], frozen=True, kw_only=True):
    """Return how a tool, whose pose in the world is given, moves the platform on a straight line to a named pose.

    All poses on the line are compared with the limits of the legs. Fails for a pose that the hexapod does not have.
    """

    pose: PoseName
    tool: Pose
