"""An arm of two joints with a gripper that holds a part, and nothing behind it: for the way back after a stop."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Self

from engine.bus import ActiveGoal, SkillBus
from engine.cell.open_cell import OpenCell
from engine.errors import RobotError, SkillFailed
from engine.messages import GripperState, JointState, Pose, RobotDescription
from engine.robot import DeviceStatus
from engine.skills.gripper import GraspResult, GripperFeedback, GripperOpen
from engine.skills.planning import FreeMotionFeedback, FreeMotionResult, MoveFree
from engine.skills.planning_scene import AttachPart, DetachPart, PlanningSceneState
from engine.skills.simulated_world import ResetParts, ResetPartsResult

START, HOME = (0.5, 0.5), (0.0, 0.1)
SCENE = PlanningSceneState(revision=1, obstacles=(), held=(), allowed=())


class HoldingArm:
    """An arm of two joints with a gripper that holds a part, and nothing behind it."""

    name = "left"
    status = DeviceStatus.READY

    def __init__(self) -> None:
        self.joints, self.part = START, "cube"
        self.fault = ""
        self.blocked = ""
        self.scene: list[tuple[str, str]] = []

    def register(self, bus: SkillBus) -> None:
        bus.topic("left/description", RobotDescription).publish(_description())
        bus.topic("left/joint_state", JointState).provide(
            lambda: JointState(
                time_s=0.0, names=("a", "b"), position_rad=self.joints, velocity_rad_s=(0.0, 0.0), effort_nm=(0.0, 0.0)
            )
        )
        bus.topic("left/gripper/state", GripperState).provide(
            lambda: GripperState(time_s=0.0, width_m=0.03, force_n=20.0, held=bool(self.part), part=self.part)
        )
        bus.advertise_action(GripperOpen, self._open, namespace="left/gripper")
        bus.advertise_action(MoveFree, self._move, namespace="left")
        bus.advertise_service(AttachPart, self._attach, namespace="cell")
        bus.advertise_service(DetachPart, self._detach, namespace="cell")
        bus.advertise_service(ResetParts, self._reset, namespace="cell")

    async def stop(self) -> None:
        if self.fault:
            raise RobotError(self.fault, hint="look at the arm")

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Nothing is open."""

    async def _open(self, goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        self.part = ""
        return GraspResult(held=False, width_m=0.08, force_n=0.0)

    async def _move(self, goal: MoveFree, handle: ActiveGoal[FreeMotionFeedback]) -> FreeMotionResult:
        handle.accept()
        if self.blocked:
            raise SkillFailed(self.blocked, where="left")
        self.joints = tuple(goal.target.joints)
        return FreeMotionResult(joints=self.joints, duration_s=1.0, stops=0, replans=0, reused=0, waited_s=0.0)

    async def _attach(self, request: AttachPart) -> PlanningSceneState:
        self.scene.append(("attach", request.part))
        return SCENE

    async def _detach(self, request: DetachPart) -> PlanningSceneState:
        self.scene.append(("detach", request.part))
        return SCENE

    async def _reset(self, request: ResetParts) -> ResetPartsResult:
        return ResetPartsResult(parts=("cube",))


def _description() -> RobotDescription:
    limits: dict[str, Any] = {
        "lower_rad": (-1.0, -1.0),
        "upper_rad": (1.0, 1.0),
        "velocity_rad_s": (1.0, 1.0),
        "acceleration_rad_s2": (1.0, 1.0),
    }
    base = Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 1.0), frame="world")
    return RobotDescription(
        name="left",
        model="m",
        urdf="",
        joint_names=("a", "b"),
        base=base,
        tool_frame="",
        tool_kind="parallel",
        **limits,
    )


def put_into(cell: OpenCell) -> HoldingArm:
    """Let an open cell have this arm."""
    arm = HoldingArm()
    arm.register(cell.bus)
    cell.robots = {"left": arm}
    return arm
