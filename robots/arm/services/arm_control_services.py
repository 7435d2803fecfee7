"""The control services of an arm: controller, stiffness, tool, load, thresholds, speed, recovery (RCY 4.1)."""

from __future__ import annotations

from typing import Any

import msgspec

from engine.bus import SkillBus
from engine.errors import RobotError, SkillFailed
from engine.skills.arm_control import (
    ArmStatus,
    ControlSettings,
    RecoverFromError,
    SetCartesianImpedance,
    SetCollisionBehavior,
    SetController,
    SetEndEffectorFrame,
    SetJointImpedance,
    SetLoad,
    SetSpeedOverride,
    SpeedOverride,
)
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.services.arm_status import ArmStatusPublisher
from robots.port import DelayedSettings

# Longest time a device may take to recover from its reflex, and the polling period.
_RECOVERY_S, _POLL_S = 1.0, 0.01
# And to adopt tool and load, which stops and starts the program of some controllers.
_SETTINGS_S = 10.0


class ArmControlServices:
    """Serves the control services by applying settings to the port.

    While a run holds the lease on the arm, other clients may call only the speed override and the recovery.
    """

    def __init__(self, runner: MotionRunner, report: ArmStatusPublisher) -> None:
        self._runner = runner
        self._report = report
        self._bus: SkillBus | None = None

    def register(self, bus: SkillBus) -> None:
        """Advertise the services under the arm's name and publish `<arm>/speed_override`."""
        self._bus, name = bus, self._runner.name
        bus.advertise_service(SetSpeedOverride, self._set_speed_override, namespace=name)
        bus.advertise_service(RecoverFromError, self._recover, namespace=name)
        bus.advertise_service(SetController, self._set_controller, namespace=name, commands=name)
        bus.advertise_service(SetJointImpedance, self._set_joint_impedance, namespace=name, commands=name)
        bus.advertise_service(SetCartesianImpedance, self._set_cartesian_impedance, namespace=name, commands=name)
        bus.advertise_service(SetEndEffectorFrame, self._set_end_effector_frame, namespace=name, commands=name)
        bus.advertise_service(SetLoad, self._set_load, namespace=name, commands=name)
        bus.advertise_service(SetCollisionBehavior, self._set_collision_behavior, namespace=name, commands=name)
        bus.topic(f"{name}/speed_override", SpeedOverride).provide(self._speed)
        self._publish_speed()

    async def _set_speed_override(self, request: SetSpeedOverride) -> ControlSettings:
        settings = self._configure(speed_override=request.share)
        self._publish_speed()
        return settings

    async def _set_controller(self, request: SetController) -> ControlSettings:
        return self._configure(controller=request.controller)

    async def _set_joint_impedance(self, request: SetJointImpedance) -> ControlSettings:
        return self._configure(
            joint_stiffness_nm_rad=request.stiffness_nm_rad, joint_damping_ratio=request.damping_ratio
        )

    async def _set_cartesian_impedance(self, request: SetCartesianImpedance) -> ControlSettings:
        return self._configure(
            cartesian_stiffness=request.stiffness,
            cartesian_damping_ratio=request.damping_ratio,
            nullspace_stiffness_nm_rad=request.nullspace_stiffness_nm_rad,
        )

    async def _set_end_effector_frame(self, request: SetEndEffectorFrame) -> ControlSettings:
        runner = self._runner
        if runner.busy:
            raise SkillFailed(
                f"the arm is busy with {runner.activity or 'a goal'}, which uses the current tool center point",
                where=runner.name,
                hint="set the frame after it has ended",
            )
        settings = self._configure(tool_xyz_m=request.xyz_m, tool_xyzw=request.xyzw)
        await self._until_applied()
        return settings

    async def _set_load(self, request: SetLoad) -> ControlSettings:
        settings = self._configure(load_kg=request.mass_kg, load_com_m=request.com_m)
        await self._until_applied()
        return settings

    async def _set_collision_behavior(self, request: SetCollisionBehavior) -> ControlSettings:
        return self._configure(collision_torque_nm=request.torque_nm, collision_force_n=request.force_n)

    async def _recover(self, request: RecoverFromError) -> ArmStatus:
        runner = self._runner
        try:
            runner.port.recover()
        except RobotError as error:
            raise SkillFailed("the arm cannot be recovered", where=runner.name) from error
        await self._until_recovered()
        runner.error = ""
        runner.changed()
        return self._report.now()

    async def _until_applied(self) -> None:
        """Return when the controller has tool and load: it may take its set point anew with them."""
        runner, port = self._runner, self._runner.port
        patience_s = runner.clock.now_s() + _SETTINGS_S
        while isinstance(port, DelayedSettings) and not port.settings_are_applied:
            if runner.clock.now_s() >= patience_s:
                raise SkillFailed(
                    f"the controller did not adopt tool and load within {_SETTINGS_S:g} s",
                    where=runner.name,
                    hint="look at the state of the device, and try again",
                )
            await runner.clock.sleep(_POLL_S)

    async def _until_recovered(self) -> None:
        """Return when the arm reports no reflex; a device may take some time."""
        runner = self._runner
        patience_s = runner.clock.now_s() + _RECOVERY_S
        while runner.port.sample().reflex:
            if runner.clock.now_s() >= patience_s:
                raise SkillFailed(
                    f"the arm has not recovered within {_RECOVERY_S:g} s",
                    where=runner.name,
                    hint="remove the external load, then try again",
                )
            await runner.clock.sleep(_POLL_S)

    def _configure(self, **changes: Any) -> ControlSettings:
        """Apply changed settings; raises SkillFailed where the arm rejects them."""
        runner = self._runner
        settings = msgspec.structs.replace(runner.port.settings, **changes)
        try:
            runner.port.configure(settings)
        except RobotError as error:
            raise SkillFailed(error.message, where=runner.name, hint=error.hint) from error
        runner.changed()
        return runner.port.settings

    def _publish_speed(self) -> None:
        if self._bus is not None:
            self._bus.topic(f"{self._runner.name}/speed_override", SpeedOverride).publish(self._speed())

    def _speed(self) -> SpeedOverride:
        return SpeedOverride(share=self._runner.port.settings.speed_override)
