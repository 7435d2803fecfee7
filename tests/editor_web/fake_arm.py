"""An arm that is only talk: its status topic, its speed, a reflex that can be recovered."""

from __future__ import annotations

from engine.bus import SkillBus
from engine.errors import SkillFailed
from engine.messages import Wrench
from engine.skills.arm_control import (
    ArmMode,
    ArmStatus,
    ControlSettings,
    RecoverFromError,
    SetSpeedOverride,
    SpeedOverride,
)

_STILL = Wrench(force_n=(0.0, 0.0, 0.0), torque_nm=(0.0, 0.0, 0.0), frame="left/tool")


class FakeArm:
    """Answers on a bus under `name`; `become` changes what it says of itself."""

    def __init__(self, bus: SkillBus, name: str) -> None:
        self.name = name
        self.share = 1.0
        self.mode: ArmMode = "idle"
        self.activity = ""
        self.error = ""
        self.stuck = False
        self._status = bus.topic(f"{name}/status", ArmStatus)
        self._speed = bus.topic(f"{name}/speed_override", SpeedOverride)
        bus.advertise_service(SetSpeedOverride, self._set_speed, namespace=name)
        bus.advertise_service(RecoverFromError, self._recover, namespace=name)
        self._publish()

    def become(self, mode: ArmMode, *, activity: str = "", error: str = "") -> None:
        """Say that it does this now."""
        self.mode, self.activity, self.error = mode, activity, error
        self._publish()

    def _settings(self) -> ControlSettings:
        return ControlSettings(
            controller="joint_impedance",
            joint_stiffness_nm_rad=(),
            joint_damping_ratio=1.0,
            cartesian_stiffness=(500.0, 500.0, 500.0, 30.0, 30.0, 30.0),
            cartesian_damping_ratio=1.0,
            nullspace_stiffness_nm_rad=20.0,
            tool_xyz_m=(0.0, 0.0, 0.0),
            tool_xyzw=(0.0, 0.0, 0.0, 1.0),
            load_kg=0.0,
            load_com_m=(0.0, 0.0, 0.0),
            collision_torque_nm=(),
            collision_force_n=None,
            speed_override=self.share,
        )

    def _now(self) -> ArmStatus:
        return ArmStatus(
            mode=self.mode,
            activity=self.activity,
            error=self.error,
            settings=self._settings(),
            external_nm=(),
            wrench=_STILL,
        )

    def _publish(self) -> None:
        self._status.publish(self._now())

    def _set_speed(self, request: SetSpeedOverride) -> ControlSettings:
        self.share = request.share
        # As the arms do: the speed has a topic of its own.
        self._speed.publish(SpeedOverride(share=self.share))
        return self._settings()

    def _recover(self, request: RecoverFromError) -> ArmStatus:
        if self.stuck:
            raise SkillFailed("the arm has not recovered within 1 s", where=self.name, hint="clear what pushes it")
        self.become("idle")
        return self._now()
