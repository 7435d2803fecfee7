"""A world that steps: physics, the controllers of its arms and fingers, and what they report."""

from __future__ import annotations

import numpy as np

from robots.control.arm_motion import ArmMotion
from robots.control.finger_servo import FingerCommand, FingerServo
from robots.control.joint_impedance import ImpedanceGains, JointImpedance
from robots.control.motion_event import AnyMotionEvent
from robots.port import Array
from robots.sim.cell_model import ArmIndices, CellModel, GripperIndices
from robots.sim.commands import (
    AnyCommand,
    Cancel,
    CloseTo,
    Follow,
    Hold,
    ResetParts,
    Restore,
    Resume,
    Shutdown,
    StopAll,
)
from robots.sim.contacts import ContactReader
from robots.sim.fingerprint import fingerprint
from robots.sim.image_layout import ImageLayout
from robots.sim.physics import Physics
from robots.sim.snapshot import ArmFields, ArmSummary, CellSummary, SnapshotLayout

# A restored arm stands where it was measured. Its set point may be this far off, as much as a
# payload takes, so that nothing sags; one that pressed on something lets go.
_NEAR_RAD = 0.01


class _Arm:
    """One arm in the loop: its indices, set point and control law."""

    def __init__(self, indices: ArmIndices, contacts: ContactReader, inertia: Array, qpos: Array) -> None:
        limits = indices.model.limits
        self.indices = indices
        self.qpos, self.dof, self.motor = indices.qpos, indices.dof, indices.motor
        self.motion = ArmMotion(
            joints=indices.model.arm_joints,
            acceleration_rad_s2=np.array(limits.acceleration_rad_s2),
            touching=lambda: contacts.describe(indices),
        )
        self.control = JointImpedance(gains=ImpedanceGains.for_limits(limits), effort_nm=np.array(limits.effort_nm))
        self.motion.initialize(qpos[indices.qpos])
        self.control.initialize(inertia_kg_m2=inertia[indices.dof])


class _Fingers:
    """One gripper in the loop."""

    def __init__(self, indices: GripperIndices, qpos: Array) -> None:
        self.indices = indices
        self.qpos, self.dof, self.motor = indices.qpos, indices.dof, indices.motor
        self.servo = FingerServo(indices.model)
        self.servo.initialize(float(qpos[indices.qpos].sum()))


class Simulation:
    """The one place where a simulated world changes.

    A step reads the state (mj_step1), moves the set points on, computes torques from quantities of
    this very state, and integrates (mj_step2): equal commands at equal steps give equal bits.
    """

    def __init__(self, cell: CellModel) -> None:
        self._cell = cell
        self._physics = physics = Physics(cell.model)
        self.step_s = physics.step_s
        self.steps = 0
        self._qpos, self._qvel = physics.positions, physics.velocities
        self._ctrl, self._bias = physics.motors, physics.bias
        self._wanted_acceleration = np.zeros(physics.dof_count)
        self._inertia_torque = np.zeros(physics.dof_count)
        self._start_poses = self._qpos[cell.part_qpos].copy()
        self._set_home()
        self._contacts = ContactReader(cell, physics)
        inertia = physics.inertia_diagonal()
        self._arms = {arm.name: _Arm(arm, self._contacts, inertia, self._qpos) for arm in cell.arms}
        self._fingers = {a.name: _Fingers(a.gripper, self._qpos) for a in cell.arms if a.gripper is not None}
        arms = _arm_summaries(cell)
        self.image_layout = ImageLayout(arms, state_size=physics.state_size)
        self.summary = _summary(cell, arms, image_size=self.image_layout.size)
        self.layout = SnapshotLayout(self.summary)

    @property
    def time_s(self) -> float:
        """Time of the world: steps done times step."""
        return self.steps * self.step_s

    @property
    def busy(self) -> bool:
        """True while a motion is under way."""
        return any(a.motion.number for a in self._arms.values()) or any(f.servo.number for f in self._fingers.values())

    def apply(self, command: AnyCommand) -> None:
        """Take a command; it acts from the next step on. Unknown motion numbers are ignored."""
        match command:
            case Follow():
                self._arms[command.arm].motion.follow(command.motion, command.trajectory(), command.tolerance())
            case CloseTo():
                fingers = self._fingers[command.arm]
                fingers.servo.close_to(
                    command.motion,
                    width_m=command.width_m,
                    speed_m_s=command.speed_m_s,
                    force_n=command.force_n,
                    now_m=float(self._qpos[fingers.qpos].sum()),
                )
            case Hold():
                for device in self._devices():
                    device.hold(command.motion, request=command.request)
            case Resume():
                for device in self._devices():
                    device.resume(command.motion, request=command.request)
            case Cancel():
                for device in self._devices():
                    device.cancel(command.motion)
            case ResetParts():
                self._qpos[self._cell.part_qpos] = self._start_poses
                self._qvel[self._cell.part_dof] = 0.0
            case Restore():
                self._restore(command.image())
            case StopAll() | Shutdown():
                for device in self._devices():
                    device.stop()

    def step(self) -> list[AnyMotionEvent]:
        """Let one step pass and return what happened to the motions."""
        events: list[AnyMotionEvent] = []
        self._physics.start_step()
        for fingers in self._fingers.values():
            self._move_fingers(fingers, events)
        accelerated = False
        for arm in self._arms.values():
            accelerated |= self._move_set_point(arm, events)
        if accelerated:
            self._physics.inertia_times(self._wanted_acceleration, out=self._inertia_torque)
        else:
            self._inertia_torque[:] = 0.0
        for arm in self._arms.values():
            self._control(arm)
        self._physics.finish_step()
        self.steps += 1
        return events

    def write_snapshot(self, values: Array) -> None:
        """Write the present state into an array made for `layout`."""
        layout = self.layout
        values[layout.time] = self.time_s
        for name, arm in self._arms.items():
            self._write_arm(values, layout.arms[name], arm)
            if name in self._fingers:
                values[layout.arms[name].gripper] = self._gripper_fields(self._fingers[name])
        xyz, wxyz = self._physics.body_poses(self._cell.frame_bodies)
        values[layout.positions] = xyz.reshape(-1)
        values[layout.quaternions] = wxyz.reshape(-1)

    def write_image(self, image: Array) -> None:
        """Write everything that the future depends on into an array of `image_layout`'s size."""
        layout = self.image_layout
        image[layout.steps] = self.steps
        self._physics.read_state(image[layout.physics])
        for name, arm in self._arms.items():
            image[layout.set_points[name]] = arm.motion.position
        for name, fingers in self._fingers.items():
            command = fingers.servo.command
            image[layout.fingers[name]] = (command.set_m, command.target_m, command.speed_m_s, command.force_n)

    def _restore(self, image: Array) -> None:
        """Stand still where an image was made; what was gripped stays gripped."""
        layout = self.image_layout
        self.steps = int(image[layout.steps])
        self._physics.rest_at(image[layout.physics])
        for name, arm in self._arms.items():
            measured = self._qpos[arm.qpos]
            set_point = np.clip(image[layout.set_points[name]], measured - _NEAR_RAD, measured + _NEAR_RAD)
            arm.motion.initialize(set_point)
        for name, fingers in self._fingers.items():
            set_m, target_m, speed_m_s, force_n = image[layout.fingers[name]].tolist()
            fingers.servo.take_over(FingerCommand(set_m=set_m, target_m=target_m, speed_m_s=speed_m_s, force_n=force_n))

    def state_hash(self) -> str:
        """Return the SHA-256 of everything that the future of the physics depends on."""
        return self._physics.state_hash()

    def _set_home(self) -> None:
        for arm in self._cell.arms:
            self._qpos[arm.qpos] = arm.model.home_rad
            if arm.gripper is not None:
                self._qpos[arm.gripper.qpos] = arm.gripper.model.max_width_m / 2
        self._physics.refresh()

    def _devices(self) -> tuple[ArmMotion | FingerServo, ...]:
        return (*(a.motion for a in self._arms.values()), *(f.servo for f in self._fingers.values()))

    def _move_fingers(self, fingers: _Fingers, events: list[AnyMotionEvent]) -> None:
        width = float(self._qpos[fingers.qpos].sum())
        velocity = float(self._qvel[fingers.dof].sum())
        events.extend(fingers.servo.step(self.step_s, width_m=width, velocity_m_s=velocity))
        self._ctrl[fingers.motor] = self._bias[fingers.dof] + fingers.servo.force_n

    def _move_set_point(self, arm: _Arm, events: list[AnyMotionEvent]) -> bool:
        motion = arm.motion
        events.extend(motion.step(self.step_s, position=self._qpos[arm.qpos], velocity=self._qvel[arm.dof]))
        self._wanted_acceleration[arm.dof] = motion.acceleration
        return motion.number != 0

    def _control(self, arm: _Arm) -> None:
        self._ctrl[arm.motor] = arm.control.step(
            position=self._qpos[arm.qpos],
            velocity=self._qvel[arm.dof],
            desired=arm.motion.position,
            desired_velocity=arm.motion.velocity,
            feedforward_nm=self._bias[arm.dof] + self._inertia_torque[arm.dof],
        )

    def _write_arm(self, values: Array, fields: ArmFields, arm: _Arm) -> None:
        values[fields.number] = arm.motion.number
        values[fields.progress] = arm.motion.progress
        block = values[fields.joints].reshape(4, fields.dof)
        block[0] = self._qpos[arm.qpos]
        block[1] = self._qvel[arm.dof]
        block[2] = self._ctrl[arm.motor]
        block[3] = arm.motion.position

    def _gripper_fields(self, fingers: _Fingers) -> tuple[float, ...]:
        left, right = self._contacts.pads(fingers.indices.pad_geoms)
        width = float(self._qpos[fingers.qpos].sum())
        return (
            fingers.servo.number,
            fingers.servo.progress(width),
            max(width, 0.0),
            float(self._qvel[fingers.dof].sum()),
            (left.force_n + right.force_n) / 2.0,
            left.body,
            right.body,
        )


def _arm_summaries(cell: CellModel) -> tuple[ArmSummary, ...]:
    return tuple(
        ArmSummary(
            name=arm.name,
            joints=arm.model.arm_joints,
            gripper_width_m=arm.gripper.model.max_width_m if arm.gripper is not None else 0.0,
        )
        for arm in cell.arms
    )


def _summary(cell: CellModel, arms: tuple[ArmSummary, ...], *, image_size: int) -> CellSummary:
    return CellSummary(
        step_s=cell.scene.step_s,
        arms=arms,
        frames=cell.frames,
        parts=cell.parts,
        bodies=cell.body_names,
        model=fingerprint(cell.model),
        image_size=image_size,
    )
