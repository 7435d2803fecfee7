"""Devices that are only talk, for the tabs that show data: joints that move, a motion with feedback, a parameter."""

from __future__ import annotations

import asyncio
import math
from typing import Annotated

import msgspec

from engine.bus import ActiveGoal, SkillBus, Topic
from engine.errors import SkillFailed
from engine.messages import GripperState, JointState, Message, Pose
from engine.skill import Action, Service

Speed = Annotated[
    float, msgspec.Meta(gt=0.0, le=1.0, description="Share of the greatest speed", extra_json_schema={"unit": "m/s"})
]


class TravelProgress(Message, frozen=True, kw_only=True):
    """How far a motion is, from 0 to 1."""

    progress: float


class Travelled(Message, frozen=True, kw_only=True):
    """Where it ended."""

    duration_s: float


class Travel(Action[Travelled, TravelProgress], frozen=True, kw_only=True):
    """Move the tool to a pose; it can be cancelled anywhere on the way."""

    target: Pose
    speed: Speed = 0.5


class Added(Message, frozen=True, kw_only=True):
    """A sum."""

    total: float


class AddNumbers(Service[Added], frozen=True, kw_only=True):
    """Add two numbers."""

    left: float
    right: float = 1.0


class LampCommand(Message, frozen=True, kw_only=True):
    """What the lamp is to do."""

    brightness: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]


class FakePlant:
    """One arm `plant` on a bus; `furnish` is given to the server, the rest is called on the server's loop."""

    def __init__(self) -> None:
        self.asked: list[Travel] = []
        self.lamp: list[LampCommand] = []
        self.goals: list[ActiveGoal[TravelProgress]] = []
        self.arrive = asyncio.Event()
        self.joints: Topic[JointState]
        self.gripper: Topic[GripperState]

    def furnish(self, bus: SkillBus) -> None:
        """Put everything on a bus."""
        self.joints = bus.topic("plant/joint_state", JointState)
        self.gripper = bus.topic("plant/gripper/state", GripperState)
        bus.topic("plant/lamp", LampCommand).subscribe_commands(self.lamp.append)
        bus.advertise_action(Travel, self.travel, namespace="plant")
        bus.advertise_service(AddNumbers, self.add_numbers, namespace="plant")
        kind = Annotated[float, msgspec.Meta(ge=0.0, le=900.0)]
        bus.parameters.declare("plant/stiffness", kind, 300.0, description="How stiffly the arm holds its place, N/m.")
        self.publish(0.0)

    def publish(self, at_s: float) -> None:
        """Publish joints and gripper as they are at a time."""
        self.joints.publish(
            JointState(
                time_s=at_s,
                names=("lift", "turn"),
                position_rad=(math.sin(at_s), 0.5 * math.cos(2 * at_s)),
                velocity_rad_s=(math.cos(at_s), -math.sin(2 * at_s)),
                effort_nm=(12.0 + math.sin(at_s), 3.0),
            )
        )
        self.gripper.publish(GripperState(time_s=at_s, width_m=0.04, force_n=0.0, held=False))

    async def travel(self, request: Travel, goal: ActiveGoal[TravelProgress]) -> Travelled:
        """Move until `arrive` is set."""
        goal.accept()
        self.asked.append(request)
        self.goals.append(goal)
        goal.feedback(TravelProgress(progress=0.25))
        await self.arrive.wait()
        return Travelled(duration_s=1.5)

    async def add_numbers(self, request: AddNumbers) -> Added:
        """Add, but refuse large numbers."""
        if request.left > 1000:
            raise SkillFailed("these numbers are too large", where="plant", hint="add smaller ones")
        return Added(total=request.left + request.right)
