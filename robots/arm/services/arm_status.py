"""The status of an arm, on request and on `<arm>/status` at every change, and its set point on `<arm>/set_point`."""

from __future__ import annotations

import numpy as np

from engine.bus import SkillBus, Topic
from engine.messages import JointSetPoint
from engine.skills.arm_control import ArmStatus, ReadArm
from robots.arm.execution.motion_runner import MotionRunner
from robots.port.set_point import to_set_point
from robots.port.wrench import to_wrench


class ArmStatusPublisher:
    """Serves ReadArm, publishes `<arm>/status`, and makes the latest `<arm>/set_point` when it is read."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._topic: Topic[ArmStatus] | None = None
        self._published: tuple[object, ...] = ()

    def register(self, bus: SkillBus) -> None:
        """Advertise the service and the topic under the arm's name."""
        name = self._runner.name
        self._topic = bus.topic(f"{name}/status", ArmStatus)
        self._topic.provide(self.now)
        bus.topic(f"{name}/set_point", JointSetPoint).provide(self._set_point)
        bus.advertise_service(ReadArm, self._read, namespace=name)
        self._runner.changed = self.publish
        self.publish()

    def now(self) -> ArmStatus:
        """Return the current status."""
        runner = self._runner
        connected = runner.mode != "disconnected"
        sample = runner.port.sample() if connected else None
        return ArmStatus(
            mode=runner.mode,
            activity=runner.activity,
            error=self._error(),
            settings=runner.port.settings,
            external_nm=tuple(sample.external_nm.tolist()) if sample is not None else (),
            wrench=to_wrench(sample.wrench if sample is not None else np.zeros(6)),
        )

    def publish(self) -> None:
        """Publish the status if it differs from the last published one."""
        runner = self._runner
        key = (runner.mode, runner.activity, self._error(), runner.port.settings)
        if self._topic is not None and key != self._published:
            self._published = key
            self._topic.publish(self.now())

    def _set_point(self) -> JointSetPoint:
        runner = self._runner
        if runner.mode == "disconnected":
            return JointSetPoint(time_s=0.0, names=(), position_rad=())
        return to_set_point(runner.port.sample(), runner.model.arm_joints)

    def _error(self) -> str:
        """Return why the last motion failed, or why the arm stopped by itself."""
        runner = self._runner
        if runner.error or runner.mode != "reflex":
            return runner.error
        # A restored arm stopped before the restart, so the runner has no error.
        return runner.port.reflex_reason

    async def _read(self, request: ReadArm) -> ArmStatus:
        return self.now()
