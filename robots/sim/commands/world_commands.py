"""Commands to a simulation, as messages that can also be sent to its own process."""

from __future__ import annotations

from engine.skills.people import Reach
from engine.skills.simulated_world import PushBody
from robots.port import Array
from robots.sim.commands.arm_commands import ArmCommand, SimCommand


class MoveTool(SimCommand, frozen=True, kw_only=True, tag="move_tool"):
    """Start a motion of the tool of `arm`; its kind says what the numbers of `goal` are."""

    arm: str
    motion: int
    goal: tuple[float, ...]


class HoldMotion(SimCommand, frozen=True, kw_only=True, tag="hold"):
    """Bring a motion to rest on its path; a motion's holds and resumes are numbered from 1 by the sender."""

    motion: int
    request: int


class ResumeMotion(SimCommand, frozen=True, kw_only=True, tag="resume"):
    """Resume a held motion."""

    motion: int
    request: int


class CancelMotion(SimCommand, frozen=True, kw_only=True, tag="cancel"):
    """Bring a motion to rest and end it."""

    motion: int


class StopAll(SimCommand, frozen=True, kw_only=True, tag="stop_all"):
    """Cancel every motion."""


class ResetFreeParts(SimCommand, frozen=True, kw_only=True, tag="reset_parts"):
    """Return the free parts to their poses in the scene, at rest."""


class PushSimBody(SimCommand, frozen=True, kw_only=True, tag="push"):
    """Push a body."""

    push: PushBody


class MovePersonHand(SimCommand, frozen=True, kw_only=True, tag="move_hand"):
    """Move the hand of a person."""

    reach: Reach


class RestoreWorld(SimCommand, frozen=True, kw_only=True, tag="restore"):
    """Restore an image of this world, at rest; its numbers are as in `ImageLayout`."""

    image: Array


class ShutDownWorld(SimCommand, frozen=True, kw_only=True, tag="shutdown"):
    """Bring everything to rest, then end the world's process."""


AnyCommand = (
    ArmCommand
    | MoveTool
    | HoldMotion
    | ResumeMotion
    | CancelMotion
    | StopAll
    | ResetFreeParts
    | PushSimBody
    | MovePersonHand
    | RestoreWorld
    | ShutDownWorld
)
