"""The topics of a real arm: joints, also in the convention of its controller, and forces."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from engine.bus import SkillBus, Topic
from engine.messages import ExternalTorque, JointSetPoint, JointState, Message, Wrench
from robots.model.robot_model import RobotModel
from robots.port import ArmPort, ArmSample
from robots.port.set_point import to_set_point
from robots.port.wrench import to_wrench

M = TypeVar("M", bound=Message)
_SET_POINT_EVERY = 5


class MeasuredTopics:
    """Publishes `<arm>/joint_state`, `/wrench`, `/external`, and `/device_joints` where they differ from the first.

    Also, every fifth time, `<arm>/set_point`, which `ArmStatusPublisher` makes when it is read.

    Args:
        bus: The bus.
        name: Name of the arm.
        port: What is measured.
        model: The arm.
    """

    def __init__(self, bus: SkillBus, name: str, port: ArmPort, model: RobotModel) -> None:
        self._port = port
        self._joints = model.arm_joints
        self._map = model.joint_map
        self._streams: list[Callable[[ArmSample], None]] = []
        self._offer(bus.topic(f"{name}/joint_state", JointState), self._joint_state)
        self._offer(bus.topic(f"{name}/wrench", Wrench), lambda sample: to_wrench(sample.wrench))
        self._offer(bus.topic(f"{name}/external", ExternalTorque), self._external)
        self._set_points = bus.topic(f"{name}/set_point", JointSetPoint)
        self._calls = 0
        if not self._map.is_identity:
            self._offer(bus.topic(f"{name}/device_joints", JointState), self._device_joints)

    def publish(self) -> None:
        """Publish to subscribers."""
        sample = self._port.sample()
        for stream in self._streams:
            stream(sample)
        self._calls += 1
        if self._calls % _SET_POINT_EVERY == 0 and self._set_points.subscriber_count > 0:
            self._set_points.publish(to_set_point(sample, self._joints))

    def _offer(self, topic: Topic[M], message: Callable[[ArmSample], M]) -> None:
        topic.provide(lambda: message(self._port.sample()))

        def publish(sample: ArmSample) -> None:
            if topic.subscriber_count > 0:
                topic.publish(message(sample))

        self._streams.append(publish)

    def _joint_state(self, sample: ArmSample) -> JointState:
        return JointState(
            time_s=sample.time_s,
            names=self._joints,
            position_rad=tuple(sample.position_rad.tolist()),
            velocity_rad_s=tuple(sample.velocity_rad_s.tolist()),
            effort_nm=tuple(sample.effort_nm.tolist()),
        )

    def _external(self, sample: ArmSample) -> ExternalTorque:
        external_nm = tuple(sample.external_nm.tolist()) or (0.0,) * len(self._joints)
        return ExternalTorque(time_s=sample.time_s, names=self._joints, torque_nm=external_nm)

    def _device_joints(self, sample: ArmSample) -> JointState:
        joint_map = self._map
        return JointState(
            time_s=sample.time_s,
            names=self._joints,
            position_rad=tuple(joint_map.to_device(sample.position_rad).tolist()),
            velocity_rad_s=tuple(joint_map.rates_to_device(sample.velocity_rad_s).tolist()),
            effort_nm=tuple(joint_map.efforts_to_device(sample.effort_nm).tolist()),
        )
