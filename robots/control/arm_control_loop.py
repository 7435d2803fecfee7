"""One arm in a control loop: external forces, set point, control law and collision reflex."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

import numpy as np
from msgspec.structs import replace

from engine.skills.arm_control import ControllerName, ControlSettings
from robots.control.arm_state import ArmState
from robots.control.carried_load import CarriedLoad
from robots.control.collision_reflex import CollisionReflex
from robots.control.friction_compensation import FrictionCompensation
from robots.control.generators.motion_generator import MotionGenerator
from robots.control.laws.cartesian_impedance import CartesianImpedance
from robots.control.laws.controller import Controller
from robots.control.laws.gravity_compensation import GravityCompensation
from robots.control.laws.joint_impedance import JointImpedance, nominal_stiffness_nm_rad
from robots.control.laws.torque_blend import TorqueBlend
from robots.control.momentum_observer import MomentumObserver
from robots.control.motion_event import AnyMotionEvent, MotionFinished, ReflexTripped
from robots.control.motion_executor import MotionExecutor
from robots.control.separation.separation_monitor import SeparationMonitor
from robots.control.set_point_watch import SetPointWatch
from robots.model.mechanics.dynamics import ArmDynamics
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array, MotionEnd, MotionReport, SeparationRule, Tolerance

# Measured forces pass this low-pass filter, as in wrist sensors.
_FELT_HZ = 60.0
_BLEND_S, _REFLEX_BLEND_S = 0.1, 0.02
# After a reflex stop the arm holds with this share of its nominal stiffness.
_REFLEX_STIFFNESS = 0.2


class ArmControlLoop:
    """Owned by one control loop, which calls `measure`, `advance` and `torque` once per period, in this order.

    Without thresholds in its settings the arm has no collision reflex. What it knows of the arm is the nominal model
    of the model folders, friction included, and the load of its settings: feed-forward and external torques are
    computed from these.

    Args:
        name: Name of the arm, for messages.
        kinematics: Kinematics of the arm, used by this loop only.
        gravity_m_s2: Gravity in the world, (3,).
        touching: Describes what the arm touches; empty for nothing.
        has_friction: False for a simulated arm without friction, which its controller then does not compensate.
        on_jump: What follows a set point beyond the limits. `report`, in simulation, sends it and reports it; `stop`,
            for real arms, never sends it: the arm brakes from the last one, and its motion fails with the cause.
        separation: The rule of speed and separation monitoring, None without it.
    """

    def __init__(
        self,
        *,
        name: str,
        kinematics: ArmKinematics,
        gravity_m_s2: Array,
        touching: Callable[[], str],
        has_friction: bool = True,
        on_jump: Literal["report", "stop"] = "report",
        separation: SeparationRule | None = None,
    ) -> None:
        from robots.control import kernels

        model, limits = kinematics.model, kinematics.limits
        self.name = name
        self.settings = ControlSettings()
        self.tool_xyz_m: Array = np.array(self.settings.tool_xyz_m)
        """Tool centre point in the frame of the tool link, (3,), from the settings."""
        self.state = ArmState(kinematics)
        self._touching = touching
        self.motion = MotionExecutor(
            joints=model.arm_joints, limits=limits, touching=self._felt, settling=self._is_settling
        )
        self._kinematics = kinematics
        self.stand = kinematics.stand
        """Where the base stands, as this loop knows it."""
        self._dynamics = dynamics = ArmDynamics(model, base=kinematics.base, gravity_m_s2=gravity_m_s2)
        # Determines the joint damping.
        self._inertia = np.diag(dynamics.mass_matrix(np.array(model.home_rad))).copy()
        self._add_feedforward = kernels.add_feedforward
        self._feedforward_nm = np.zeros(model.dof)
        self._friction = FrictionCompensation(model.friction) if has_friction else None
        self._observer = MomentumObserver(model.dof)
        self._limit_nm = np.array(limits.effort_nm)
        self._load = CarriedLoad(kinematics, gravity_m_s2=gravity_m_s2)
        self.watch = SetPointWatch(arm=name, joints=model.arm_joints, limits=limits)
        """Compares every set point with the limits."""
        self._on_jump = on_jump
        self.separation = SeparationMonitor(separation, kinematics=kinematics.twin()) if separation else None
        """Speed and separation monitoring, if the cell has it."""
        self._reflex = CollisionReflex(joints=model.arm_joints, touching=touching)
        cartesian = CartesianImpedance(
            limits, mass_matrix=kinematics.mass_matrix, base_rotation=kinematics.base.rotation
        )
        self._holding: dict[ControllerName, Controller] = {
            "joint_impedance": JointImpedance(limits),
            "cartesian_impedance": cartesian,
        }
        # The others yield: a guided arm has no set point of its own, and one after a reflex shall not press.
        self._integrating = frozenset(self._holding.values())
        self._floating = GravityCompensation(limits)
        self._yielding = JointImpedance(limits)
        self._law: Controller = self._holding[self.settings.controller]
        self._blend = TorqueBlend(limit_nm=self._limit_nm)
        self._untold: list[AnyMotionEvent] = []
        for law in (*self._holding.values(), self._floating):
            law.initialize(settings=self.settings, inertia_kg_m2=self._inertia)
        soft = tuple((_REFLEX_STIFFNESS * nominal_stiffness_nm_rad(limits)).tolist())
        self._yielding.initialize(settings=ControlSettings(joint_stiffness_nm_rad=soft), inertia_kg_m2=self._inertia)

    @property
    def reflex(self) -> bool:
        """True from a reflex stop until `recover`."""
        return bool(self._reflex.reason)

    def _is_settling(self) -> bool:
        return self._friction is not None and self._friction.is_settling

    def _felt(self) -> str:
        """Describe what the arm touches, and what it carries that its settings do not know."""
        unknown_kg = self._load.unknown_kg(self.state.wrench[:3])
        weight = f"the tool is pulled down as by {unknown_kg:.1f} kg more than the load that is set (motion.SetLoad)"
        return "; ".join(filter(None, (self._touching(), weight if unknown_kg else "")))

    @property
    def has_unreported_end(self) -> bool:
        """True while `advance` has an earlier event to report."""
        return bool(self._untold)

    def initialize(self, position: Array, *, reflex: bool = False) -> None:
        """Hold `position`, with or without an active reflex; drops the active motion and the filtered forces."""
        self.motion.initialize(position)
        self.watch.restart(position)
        self._observer.forget()
        self.state.external_nm[:] = 0.0
        self.state.wrench[:] = 0.0
        self._load.forget_motion()
        if self._friction is not None:
            self._friction.forget()
        self._untold.clear()
        if self.separation is not None:
            self.separation.forget()
        self._reflex.reason = "it had stopped before" if reflex else ""
        self._law = self._selected_law()
        self._blend.forget()

    def configure(self, settings: ControlSettings) -> None:
        """Apply validated settings without a torque jump, also during a motion."""
        before, self.settings = self.settings, settings
        self.tool_xyz_m = np.array(settings.tool_xyz_m)
        self.motion.pace = settings.speed_override
        self._reflex.watch(settings)
        if _shape(before) == _shape(settings):
            return
        if (settings.tool_xyz_m, settings.tool_xyzw) != (before.tool_xyz_m, before.tool_xyzw):
            tool = RigidTransform.of(settings.tool_xyz_m, settings.tool_xyzw)
            self.state.kinematics = self._kinematics.with_tool(tool)
        if (settings.load_kg, settings.load_com_m) != (before.load_kg, before.load_com_m):
            self._load.take(settings)
        for law in self._holding.values():
            law.initialize(settings=settings, inertia_kg_m2=self._inertia)
        self._blend.start(duration_s=_BLEND_S)

    def start(self, number: int, generator: MotionGenerator, tolerance: Tolerance) -> None:
        """Start a motion; it fails at once if the reflex has tripped meanwhile."""
        if self.reflex:
            reason = f"the arm has stopped by itself: {self._reflex.reason}"
            report = MotionReport(end=MotionEnd.FAILED, reason=reason)
            self._untold.append(MotionFinished(motion=number, progress=0.0, report=report))
            return
        self.motion.start(number, generator, tolerance)

    def float_with(self, *, damping_share: float) -> None:
        """Set the share of the joint damping that remains in gravity compensation."""
        self._floating.damping_share = damping_share

    def recover(self) -> None:
        """End a reflex: hold where the arm stands."""
        if not self.reflex:
            return
        self._reflex.reason = ""
        if self.motion.number == 0:
            self.motion.initialize(self.state.position)
            self.watch.restart(self.state.position)

    def measure(self, position: Array, velocity: Array, *, wrench: Array, step_s: float) -> None:
        """Take the measurements of a period.

        `wrench` (6,) is the force and torque of everything outside the arm's model on the tool, about the tool centre
        point, world axes; that of the load is subtracted.
        """
        state, load_nm = self.state, None
        state.refill(position, velocity)
        if not self._load.none:
            self._load.measure(state, step_s)
            load_nm = self._load.felt_nm()
            wrench = wrench - self._load.felt_at(state.tool.xyz)
        self._observer.measure(velocity, load_nm=load_nm, step_s=step_s)
        state.external_nm[:] = self._observer.external_nm
        share = 1.0 - math.exp(-2.0 * math.pi * _FELT_HZ * step_s)
        state.wrench += share * (wrench - state.wrench)

    def advance(self, step_s: float) -> list[AnyMotionEvent]:
        """Advance the set point by one period and return the events."""
        events, self._untold = self._untold, []
        # A hand that guides the arm is not a collision.
        if self.motion.leads and self._reflex.trips(self.state):
            self.motion.fail(self._reflex.reason)
            events.append(ReflexTripped(motion=self.motion.number, arm=self.name, reason=self._reflex.reason))
        if self.separation is not None:
            self.motion.permitted_pace = self.separation.permitted_share(step_s, self.motion.generator)
        events.extend(self.motion.step(step_s, self.state))
        jump = self.watch.look(step_s, self.motion)
        if jump is not None:
            events.append(jump)
            if self._on_jump == "stop":
                self.motion.reject(jump.reason, self.watch.reject(), step_s=step_s)
                self.watch.look(step_s, self.motion)
        return events

    def torque(self, *, step_s: float) -> Array:
        """Return the joint torques, (n,), within the limits; reused by the next call."""
        law = self._selected_law()
        if law is not self._law:
            self._law.terminate()
            self._law = law
            self._blend.start(duration_s=_REFLEX_BLEND_S if law is self._yielding else _BLEND_S)
            if self._friction is not None:
                self._friction.forget()
        state, motion, dynamics = self.state, self.motion, self._dynamics
        mass = dynamics.mass_matrix(state.position)
        bias_nm = dynamics.bias(state.position, state.velocity)
        feedforward_nm = self._feedforward_nm
        damping, acceleration = dynamics.damping_nms_rad, motion.acceleration
        self._add_feedforward(mass, bias_nm, state.velocity, acceleration, damping, feedforward_nm)
        friction = self._friction
        if friction is not None:
            if motion.leads:
                feedforward_nm += friction.ahead(motion.velocity)
            else:
                feedforward_nm += friction.helping(state.velocity, pushed_nm=state.wrench @ state.jacobian)
            bias_nm = bias_nm + friction.along(state.velocity)
        bearing_nm = feedforward_nm
        if not self._load.none:
            bearing_nm = feedforward_nm + self._load.bearing_nm(acceleration)
        torque = law.step(state, motion, feedforward_nm=bearing_nm)
        if friction is not None and law in self._integrating:
            spring_nm = torque - bearing_nm
            torque = torque + friction.integrate(spring_nm, velocity=motion.velocity, step_s=step_s)
            torque = np.minimum(np.maximum(torque, -self._limit_nm), self._limit_nm)
        torque = self._blend.after(torque, feedforward_nm=feedforward_nm, step_s=step_s)
        self._observer.command(torque, velocity=state.velocity, mass_matrix=mass, bias_nm=bias_nm)
        return torque

    def _selected_law(self) -> Controller:
        if not self.motion.leads:
            return self._floating
        return self._yielding if self.reflex else self._holding[self.settings.controller]


def _shape(settings: ControlSettings) -> ControlSettings:
    """Return `settings` reduced to what changes the torques of an arm at rest."""
    return replace(settings, collision_torque_nm=(), collision_force_n=None, speed_override=1.0)
