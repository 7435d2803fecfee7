"""One arm in the loop of a simulated world: connects the physics to its control loop, or mirrors a real arm."""

from __future__ import annotations

import numpy as np

from robots.control.arm_control_loop import ArmControlLoop
from robots.control.commanding.arm_command_handler import ArmCommandHandler
from robots.control.commanding.arm_commands import ArmCommand
from robots.control.motion_event import AnyMotionEvent
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array, SeparationRule
from robots.sim.loop.arm_hardware import ArmHardware
from robots.sim.measures.run_measures import LoopArm
from robots.sim.physics.cell_model import ArmIndices
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics

# A restored arm stands where it was measured. Its set point may be this far off, the sag of a
# payload, so that nothing drops; an arm that pressed on something releases it.
_NEAR_RAD = 0.01


class SimArmLoop:
    """Call `move` and then `drive` between the halves of a step of the physics."""

    def __init__(
        self,
        indices: ArmIndices,
        *,
        base: RigidTransform,
        physics: Physics,
        contacts: ContactReader,
        hardware: ArmHardware,
        separation: SeparationRule | None = None,
        has_friction: bool,
        driven: bool = False,
    ) -> None:
        model = indices.model
        self.indices = indices
        self._physics = physics
        self._is_driven = driven
        self._mirrored = (physics.positions[indices.qpos], np.zeros(model.dof))
        self._hardware = hardware
        self._tool_link = physics.body_number(f"{indices.name}/{model.tool_link}")
        self._beyond_flange = physics.members(physics.body_number(f"{indices.name}/{model.flange_link}"))
        self._tool_xyz: Array = np.zeros(3)
        self.control = ArmControlLoop(
            name=indices.name,
            kinematics=ArmKinematics(model, base=base),
            gravity_m_s2=physics.gravity_m_s2,
            touching=lambda: contacts.describe(indices),
            separation=separation,
            has_friction=has_friction,
        )
        self.control.initialize(physics.positions[indices.qpos])
        self._commands = ArmCommandHandler(
            self.control, model=model, measured_rad=lambda: physics.positions[indices.qpos]
        )

    @property
    def busy(self) -> bool:
        """True while a motion is active, or its end is not reported yet."""
        return self.control.motion.number != 0 or self.control.has_unreported_end

    def measured(self) -> LoopArm:
        """Return what the measures of a run need of this arm."""
        return LoopArm(
            control=self.control,
            tool_xyz=lambda: self._tool_xyz,
            tool_link=self._tool_link,
            beyond_flange=frozenset(self._beyond_flange.tolist()),
        )

    def take(self, command: ArmCommand) -> None:
        """Apply a command to this arm from the next step on; numbers of other motions are ignored."""
        self._commands.take(command)

    def mirror(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Take the measured joints of a driven arm, (n,)."""
        self._mirrored = (position_rad, velocity_rad_s)

    def place(self) -> None:
        """Place a driven arm where it is measured; before the physics of a step."""
        if self._is_driven:
            physics, indices = self._physics, self.indices
            physics.positions[indices.qpos], physics.velocities[indices.dof] = self._mirrored

    def measured_joints(self, step: int) -> tuple[Array, Array]:
        """Return the measured joint positions and velocities, (n,), before this step."""
        if self._is_driven:
            return self._mirrored
        physics, indices = self._physics, self.indices
        return self._hardware.joints(physics.positions[indices.qpos], physics.velocities[indices.dof], step=step)

    def measured_effort(self, step: int) -> Array:
        """Return the measured motor torques, (n,), before this step."""
        return self._hardware.effort(self._physics.motors[self.indices.motor], step=step)

    def move(self, step_s: float, *, step: int) -> list[AnyMotionEvent]:
        """Read the measurements, advance the set point, and return the events."""
        physics, control = self._physics, self.control
        self._tool_xyz = physics.point_of(self._tool_link, control.tool_xyz_m)
        position, velocity = self.measured_joints(step)
        if self._is_driven:
            control.state.refill(position, velocity)
            control.motion.position[:] = position
            return []
        wrench = self._hardware.wrench(
            physics.wrench_on(self._beyond_flange, self._tool_xyz), axes=physics.axes_of(self._tool_link), step=step
        )
        control.measure(position, velocity, wrench=wrench, step_s=step_s)
        return control.advance(step_s)

    def drive(self, *, step_s: float) -> None:
        """Set the motors; a driven arm has none here."""
        if self._is_driven:
            return
        self._physics.motors[self.indices.motor] = self._hardware.drive(self.control.torque(step_s=step_s))

    def rest_near(self, set_point: Array, *, reflex: bool) -> None:
        """Hold `set_point`, clipped to the neighbourhood of the measured position."""
        self._hardware.forget()
        measured = self._physics.positions[self.indices.qpos]
        near = np.clip(set_point, measured - _NEAR_RAD, measured + _NEAR_RAD)
        self.control.initialize(near, reflex=reflex)
