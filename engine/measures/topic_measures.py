"""Measures of arms from what they publish: of real arms, and of recorded runs, which have no simulated world."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from typing import Any

from engine.bus import SkillBus, Subscription, Topic
from engine.measures.arm_sums import ARM_MEASURES, ArmSums
from engine.messages import FramePoses, JointState, Message, Quaternion, RobotDescription, Vector3, Wrench
from engine.skills.arm_control import ArmStatus

SAMPLE_S = 0.025
"""Path and speed are those of samples at least so far apart, as in a simulated world: noise of faster ones adds up."""

_SLACK_S = 1e-6
_FRAMES = "cell/frames"
_KINDS: Mapping[str, type[Message]] = {
    "description": RobotDescription,
    "status": ArmStatus,
    "joint_state": JointState,
    "wrench": Wrench,
}
"""What is read of an arm, by the end of the topic's name."""


class TopicMeasures:
    """Sums up the topics of arms, a `MeasurePort`.

    `<arm>/joint_state` gives the path of the joints, `<arm>/wrench` forces and torques on the tool, `cell/frames`
    with the tool frame of `<arm>/description` and the tool centre point in `<arm>/status` path and speed of the tool.
    What is not published is missing. Set points are on no topic: there is no tracking error.

    Args:
        arms: The arms; None for all that publish more than a wrench.
    """

    def __init__(self, arms: Collection[str] | None = None) -> None:
        self._names = arms
        self._arms: dict[str, _Arm] = {}

    def kind(self, topic: str) -> type[Message] | None:
        """Return the type of message that is read of a topic; None for one that is not read."""
        if topic == _FRAMES:
            return FramePoses
        arm, _, what = topic.rpartition("/")
        return _KINDS.get(what) if arm and (self._names is None or arm in self._names) else None

    def take(self, topic: str, message: Message) -> None:
        """Take note of a message."""
        if isinstance(message, FramePoses):
            for arm in self._arms.values():
                arm.frames(message)
            return
        arm = self._arms.setdefault(topic.rpartition("/")[0], _Arm())
        match message:
            case RobotDescription():
                arm.described(message.tool_frame)
            case ArmStatus():
                arm.tool_centre(message.settings.tool_xyz_m)
            case JointState():
                arm.joints(message)
            case Wrench():
                arm.sums.press(math.hypot(*message.force_n), math.hypot(*message.torque_nm))
            case _:
                pass

    def listen(self, bus: SkillBus) -> Callable[[], None]:
        """Read the topics of a bus from now on, those made later included; returns a function that ends this."""
        subscriptions: list[Subscription[Any]] = []

        def add(topic: Topic[Any]) -> None:
            kind, name = self.kind(topic.name), topic.name
            if kind is None or not issubclass(topic.kind, kind):
                return
            if topic.latest is not None:
                self.take(name, topic.latest)
            subscriptions.append(topic.subscribe(lambda message: self.take(name, message)))

        unwatch = bus.watch_topics(add)

        def end() -> None:
            unwatch()
            for subscription in subscriptions:
                subscription.close()

        return end

    def measures(self) -> dict[str, float]:
        """Return what has been summed up, by name as in `engine.messages.measures`."""
        return {
            f"{name}.{measure.name}": value
            for name, arm in self._arms.items()
            if arm.known
            for measure, value in zip(ARM_MEASURES, arm.sums.values, strict=True)
            if not math.isnan(value)
        }


class _Arm:
    """One arm."""

    def __init__(self) -> None:
        self.sums = ArmSums()
        self.known = False
        """Whether it is an arm: a force sensor has a wrench, too."""
        self._tool_frame = ""
        self._tool_xyz_m: Vector3 = (0.0, 0.0, 0.0)
        self._moved_s = self._turned_s = -math.inf

    def described(self, tool_frame: str) -> None:
        """Take note of the frame of the tool link."""
        self.known, self._tool_frame = True, tool_frame

    def tool_centre(self, tool_xyz_m: Vector3) -> None:
        """Take note of where the tool centre point is in that frame; another one is no movement."""
        self.known = True
        if tool_xyz_m != self._tool_xyz_m:
            self._tool_xyz_m = tool_xyz_m
            self.sums.leave_tool()

    def joints(self, state: JointState) -> None:
        """Take a sample of the joints, if it is due."""
        self.known = True
        if state.time_s < self._turned_s:
            # The clock of the device began again: it was connected again.
            self.sums.leave()
            self._moved_s = -math.inf
        elif state.time_s < self._turned_s + SAMPLE_S - _SLACK_S:
            return
        self.sums.move_joints(state.position_rad)
        self._turned_s = state.time_s

    def frames(self, poses: FramePoses) -> None:
        """Take a sample of the tool centre point, if it is due."""
        if not self._tool_frame or self._tool_frame not in poses.names:
            return
        passed_s = poses.time_s - self._moved_s
        if passed_s < 0.0:
            self.sums.leave_tool()
        elif passed_s < SAMPLE_S - _SLACK_S:
            return
        row = poses.names.index(self._tool_frame)
        self.sums.move_tool(_point(poses.xyz[row], poses.xyzw[row], self._tool_xyz_m), passed_s)
        self._moved_s = poses.time_s


def _point(xyz: Vector3, xyzw: Quaternion, offset_m: Vector3) -> Vector3:
    """Return a point given in a frame in the world."""
    x, y, z, w = xyzw
    a, b, c = offset_m
    # Twice the cross product of the vector part and the offset.
    u, v, t = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return (
        xyz[0] + a + w * u + y * t - z * v,
        xyz[1] + b + w * v + z * u - x * t,
        xyz[2] + c + w * t + x * v - y * u,
    )
