"""The joints of an arm of a simulated world, as an emulated controller moves them."""

from __future__ import annotations

import asyncio

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.model.joint_map import JointMap
from robots.port import ArmPort, Array, MotionStream

_WATCHDOG_S = 1.0


class WorldArm:
    """Implements `ArmPlant`: streams the set points to the arm's control loop in the world.

    The loop stands for the servo amplifiers: torques from set points, with the friction, the delay and the noise of
    the world's realism. `joint_map` says how the angles of the controller are those of the world's joints.
    """

    def __init__(self, port: ArmPort, joint_map: JointMap) -> None:
        self._port = port
        self._map = joint_map
        self._stream: MotionStream | None = None
        self._watching: asyncio.Task[None] | None = None
        self._load_kg = 0.0
        self._problem = ""

    @property
    def problem(self) -> str:
        """Why the joints do not follow: too far behind, or the world is lost."""
        return self._problem

    def follow(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Send the set point to the world; it acts within two cycles of the controller."""
        if self._problem:
            return
        try:
            if self._stream is None:
                self._stream = stream = self._port.stream("joint_position", watchdog_s=_WATCHDOG_S)
                self._watching = asyncio.get_running_loop().create_task(self._watch(stream))
            self._stream.send(tuple(self._map.to_model(position_rad).tolist()))
        except RobotError as error:
            self._problem = str(error)

    def carry(self, mass_kg: float) -> None:
        """Add the weight of the load to the torques."""
        if mass_kg != self._load_kg:
            self._load_kg = mass_kg
            self._port.configure(ControlSettings(load_kg=mass_kg))

    def measured(self) -> tuple[Array, Array]:
        """Return the positions and velocities that the encoders of the world measure."""
        sample = self._port.sample()
        return self._map.to_device(sample.position_rad), self._map.rates_to_device(sample.velocity_rad_s)

    def reset(self) -> None:
        """Follow again from where the joints are."""
        self._problem, self._stream = "", None

    async def _watch(self, stream: MotionStream) -> None:
        report = await stream.report()
        if self._stream is stream:
            self._problem = report.reason or "the joints do not follow any more"
