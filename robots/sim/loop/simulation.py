"""The simulation loop of a world: physics, the controllers of arms and tools, and their events."""

from __future__ import annotations

from copy import copy

import numpy as np

from robots.control.arm_control_loop import ArmControlLoop
from robots.control.commanding.arm_commands import CancelMotion, CommandToArm, HoldMotion, ResumeMotion, StopAll
from robots.control.motion_event import AnyMotionEvent
from robots.control.motion_executor import MotionExecutor
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.realism import realism
from robots.sim.commands.world_commands import (
    AnyCommand,
    BrakeCarriage,
    BrakeLegs,
    DriveAxis,
    MirrorArm,
    MirrorPart,
    MirrorTool,
    ModulePlaced,
    MovePersonHand,
    MoveTool,
    PlaceModule,
    PushSimBody,
    ResetFreeParts,
    RestoreWorld,
    ShutDownWorld,
    SwitchToolLock,
)
from robots.sim.grip.mechanics import ToolDrive, ToolMechanics, new_mechanics
from robots.sim.grip.tool_summary import tool_summary
from robots.sim.loop.arm_hardware import arm_hardware
from robots.sim.loop.arm_loop import SimArmLoop
from robots.sim.loop.belts import Belts
from robots.sim.loop.bonds import Bonds
from robots.sim.loop.carriages import Carriages, has_carriages
from robots.sim.loop.device_axes import DeviceAxes, has_axes
from robots.sim.loop.docked_modules import DockedModules
from robots.sim.loop.external_pushes import ExternalPushes
from robots.sim.loop.held_parts import HeldParts
from robots.sim.loop.hexapod_brakes import HexapodBrakes
from robots.sim.loop.image_layout import TOOL_FIELDS, ImageLayout
from robots.sim.loop.snapshot import ArmFields, ArmSummary, CellSummary, SnapshotLayout
from robots.sim.loop.tool_locks import ToolLocks
from robots.sim.measures.run_measures import RunMeasures
from robots.sim.people.people_loop import PeopleLoop
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.fingerprint import fingerprint
from robots.sim.physics.physics import Physics

_SceneCommand = MirrorArm | MirrorTool | MirrorPart | DriveAxis | BrakeLegs | BrakeCarriage | SwitchToolLock
_REST_RAD_S = 0.01


class Simulation:
    """The only place where a simulated world changes.

    A step reads the state (mj_step1), advances the set points, computes torques from
    this state, and integrates (mj_step2): equal commands at equal steps give equal bits.
    """

    def __init__(self, cell: CellModel) -> None:
        self._cell = cell
        # Modules, axes and carriages change the model; a built cell is only read.
        changes = bool(cell.scene.modules) or has_axes(cell) or has_carriages(cell)
        self._physics = physics = Physics(copy(cell.model) if changes else cell.model)
        self.step_s = physics.step_s
        self.steps = 0
        self._qpos, self._qvel = physics.positions, physics.velocities
        self._start_poses = self._qpos[cell.free_qpos].copy()
        self._set_home()
        # Before modules go: the same for all worlds of one scene.
        model = fingerprint(cell.model)
        self._bonds = Bonds(cell, physics)
        self._modules = DockedModules(cell, physics, joined_to=self._bonds.joined_to)
        self._bonds.keep_apart(self._modules.away)
        self._contacts = ContactReader(cell, physics)
        bases = {arm.name: RigidTransform.from_pose(arm.base) for arm in cell.scene.arms}
        driven = {placement.name for placement in cell.scene.arms if placement.driven}
        self._arms = {
            arm.name: SimArmLoop(
                arm,
                base=bases[arm.name],
                physics=physics,
                contacts=self._contacts,
                hardware=arm_hardware(
                    arm.name,
                    limits=arm.model.limits,
                    realism=realism(cell.scene.realism),
                    seed=cell.scene.seed,
                    step_s=self.step_s,
                ),
                separation=cell.scene.separation,
                has_friction=realism(cell.scene.realism).coulomb_share > 0.0,
                driven=arm.name in driven,
            )
            for arm in cell.arms
        }
        self._hands = ExternalPushes(physics)
        self._axes, self._belts = DeviceAxes(cell, physics), Belts(cell, physics)
        self._legs = HexapodBrakes(cell, physics)
        self._carriages = Carriages(cell, physics, {name: arm.control for name, arm in self._arms.items()})
        self._held_parts = HeldParts(cell, physics)
        self._locks = ToolLocks(cell, physics)
        self._people = PeopleLoop(cell, physics, step_s=self.step_s)
        tools = {arm.name: new_mechanics(arm, physics, self._contacts) for arm in cell.arms}
        self._tools: dict[str, ToolMechanics] = {name: tool for name, tool in tools.items() if tool is not None}
        self.measures = RunMeasures(
            cell,
            physics,
            arms={name: arm.measured() for name, arm in self._arms.items()},
            tools=self._tools,
            locks=self._locks.moving,
            step_s=self.step_s,
        )
        """What the world sums up while it runs."""
        arms = _arm_summaries(cell)
        self._tool_names = {arm.name: f"{arm.name}/{arm.tool.kind}" for arm in arms if arm.tool is not None}
        self._arm_dof = np.concatenate(
            [np.zeros(0, dtype=np.intp), *(arm.dof for arm in cell.arms if arm.name not in driven)]
        )
        self.image_layout = ImageLayout(
            arms,
            state_size=physics.state_size,
            modules_size=self._modules.image_size,
            bonds_size=self._bonds.image_size,
            people_size=self._people.image_size,
        )
        self.summary = _summary(cell, arms, model=model, image=self.image_layout)
        self.layout = SnapshotLayout(self.summary)

    @property
    def time_s(self) -> float:
        """Time of the world: step count times step."""
        return self.steps * self.step_s

    @property
    def busy(self) -> bool:
        """True while a motion is active."""
        return any(a.busy for a in self._arms.values()) or any(t.drive.number for t in self._tools.values())

    @property
    def at_rest(self) -> bool:
        """True when no motion is active and all measured arm speeds are at rest."""
        return not self.busy and bool((np.abs(self._qvel[self._arm_dof]) < _REST_RAD_S).all())

    def brake(self, cause: str) -> None:
        """Bring every motion to rest within its limits; each ends as FAILED with `cause` and its device's name."""
        for name, arm in self._arms.items():
            arm.control.motion.stop(f"{cause}; {name} came to rest by itself")
        for name, tool in self._tools.items():
            tool.drive.stop(f"{cause}; {self._tool_names[name]} came to rest by itself")

    def control(self, arm: str) -> ArmControlLoop:
        """Return the control loop of an arm, for tests and measurements."""
        return self._arms[arm].control

    def touching(self, arm: str) -> str:
        """Describe what an arm touches after the last step, empty for nothing; for tests and measurements."""
        return self._contacts.describe(self._arms[arm].indices)

    def apply(self, command: AnyCommand) -> None:
        """Apply a command from the next step on; unknown motion numbers are ignored."""
        match command:
            case CommandToArm():
                self._arms[command.arm].take(command)
            case MoveTool():
                self._tools[command.arm].begin(command.motion, command.goal)
            case (
                MirrorArm()
                | MirrorTool()
                | MirrorPart()
                | DriveAxis()
                | BrakeLegs()
                | BrakeCarriage()
                | SwitchToolLock()
            ):
                self._follow(command)
            case HoldMotion():
                for device in self._devices():
                    device.hold(command.motion, request=command.request)
            case ResumeMotion():
                for device in self._devices():
                    device.resume(command.motion, request=command.request)
            case CancelMotion():
                for device in self._devices():
                    device.cancel(command.motion)
            case PushSimBody():
                self._hands.push(command.push)
            case MovePersonHand():
                self._people.send(command.reach)
            case ResetFreeParts():
                self._qpos[self._cell.free_qpos] = self._start_poses
                self._qvel[self._cell.free_dof] = 0.0
                self._locks.reset()
                self._modules.reset()
                self._bonds.reset()
                self._bonds.keep_apart(self._modules.away)
            case RestoreWorld():
                self._restore(command.image)
            case StopAll() | ShutDownWorld():
                for device in self._devices():
                    device.stop()

    def place_module(self, command: PlaceModule) -> ModulePlaced:
        """Plug or unplug a module from the next step on; nothing else of the state changes."""
        numbers = [self._held_number(name) for name in self._arms]
        held = frozenset(self._cell.parts[number] for number in numbers if number >= 0)
        placed = self._modules.place(command, held=held)
        self._bonds.keep_apart(placed.away)
        return placed

    def _follow(self, command: _SceneCommand) -> None:
        match command:
            case DriveAxis():
                self._axes.drive(command)
                self._belts.drive(command)
            case BrakeLegs():
                self._legs.brake(command)
            case BrakeCarriage():
                self._carriages.brake(command)
            case SwitchToolLock():
                self._locks.switch(command)
            case MirrorArm():
                self._arms[command.arm].mirror(command.position_rad, command.velocity_rad_s)
            case MirrorTool():
                self._held_parts.report(command.arm, held=command.held)
            case MirrorPart():
                self._held_parts.mirror(command.part, command.pose)

    def step(self) -> list[AnyMotionEvent]:
        """Simulate one step and return the motion events."""
        events: list[AnyMotionEvent] = []
        self._people.place()
        for arm in self._arms.values():
            arm.place()
        self._held_parts.place()
        self._modules.pin()
        self._belts.run(self.step_s)
        self._physics.start_step()
        self._legs.step()
        self._carriages.step()
        for tool in self._tools.values():
            events.extend(tool.step(self.step_s))
        for arm in self._arms.values():
            events.extend(arm.move(self.step_s, step=self.steps))
            arm.drive(step_s=self.step_s)
        self._hands.step(self.step_s)
        self._physics.finish_step()
        self._locks.step()
        self._bonds.step()
        self._people.count()
        self.steps += 1
        self.measures.step(self.steps)
        return events

    def write_snapshot(self, values: Array) -> None:
        """Write the present state into an array made for `layout`."""
        layout = self.layout
        values[layout.time] = self.time_s
        for name, arm in self._arms.items():
            self._write_arm(values, layout.arms[name], arm)
            values[layout.arms[name].held] = self._held_number(name)
            if name in self.image_layout.locks:
                values[layout.arms[name].lock] = self._locks.read(name)
            if name in self._tools:
                tool = self._tools[name]
                values[layout.arms[name].tool] = (tool.drive.number, *tool.measured())
        xyz, wxyz = self._physics.body_poses(self._cell.frame_bodies)
        values[layout.positions] = xyz.reshape(-1)
        values[layout.quaternions] = wxyz.reshape(-1)
        self._people.write_report(values[layout.people])
        values[layout.measures] = self.measures.summed_up
        self._bonds.write_report(values[layout.bonds])

    def write_image(self, image: Array) -> None:
        """Write the complete state into an array of `image_layout`'s size."""
        layout = self.image_layout
        image[layout.steps] = self.steps
        self._physics.read_state(image[layout.physics])
        self._modules.write_image(image[layout.modules])
        self._bonds.write_image(image[layout.bonds])
        for name, arm in self._arms.items():
            image[layout.set_points[name]] = arm.control.motion.position
            image[layout.reflexes[name]] = arm.control.reflex
        for name, tool in self._tools.items():
            command = tool.command()
            image[layout.tools[name]] = (*command, *(0.0,) * (TOOL_FIELDS - len(command)))
        for name, place in layout.locks.items():
            self._locks.write_image(name, image[place])
        self._people.write_image(image[layout.people])

    def _restore(self, image: Array) -> None:
        """Restore an image at rest; gripped objects stay gripped, and people continue their motions."""
        layout = self.image_layout
        self.steps = int(image[layout.steps])
        self._hands.let_go()
        self._modules.take_over(image[layout.modules])
        self._physics.rest_at(image[layout.physics])
        self._bonds.take_over(image[layout.bonds], away=self._modules.away)
        self._held_parts.restart()
        self._belts.stand()
        for name, arm in self._arms.items():
            arm.rest_near(image[layout.set_points[name]], reflex=bool(image[layout.reflexes[name]]))
        for name, tool in self._tools.items():
            tool.take_over(tuple(image[layout.tools[name]].tolist()))
        for name, place in layout.locks.items():
            self._locks.take_over(name, image[place])
        self._people.take_over(image[layout.people])
        self.measures.restart(self.steps)

    def state_hash(self) -> str:
        """Return the SHA-256 of everything that the future of the physics depends on."""
        return self._physics.state_hash()

    def _set_home(self) -> None:
        for arm in self._cell.arms:
            self._qpos[arm.qpos] = arm.model.home_rad
            if arm.tool is not None:
                self._qpos[arm.tool.qpos] = arm.tool.home
        self._physics.refresh()

    def _held_number(self, arm: str) -> int:
        """Return the number of the part that follows a driven tool or is in a tool changer, -1 for none."""
        return max(self._held_parts.number(arm), self._locks.number(arm))

    def _devices(self) -> tuple[MotionExecutor | ToolDrive, ...]:
        return (*(a.control.motion for a in self._arms.values()), *(t.drive for t in self._tools.values()))

    def _write_arm(self, values: Array, fields: ArmFields, arm: SimArmLoop) -> None:
        control = arm.control
        values[fields.number] = control.motion.number
        values[fields.progress] = control.motion.progress
        values[fields.reflex] = control.reflex
        if control.separation is not None:
            permitted = control.separation.permitted
            values[fields.separation] = permitted.share, permitted.speed_m_s, permitted.protective_m
        values[fields.wrench] = control.state.wrench
        block = values[fields.joints].reshape(5, fields.dof)
        block[0], block[1] = arm.measured_joints(self.steps)
        block[2] = arm.measured_effort(self.steps)
        block[3] = control.motion.position
        block[4] = control.state.external_nm


def _arm_summaries(cell: CellModel) -> tuple[ArmSummary, ...]:
    return tuple(
        ArmSummary(
            name=arm.name,
            joints=arm.model.arm_joints,
            tool=tool_summary(arm.model.tool),
            tool_changer=placement.tool_changer is not None,
        )
        for arm, placement in zip(cell.arms, cell.scene.arms, strict=True)
    )


def _summary(cell: CellModel, arms: tuple[ArmSummary, ...], *, model: str, image: ImageLayout) -> CellSummary:
    return CellSummary(
        step_s=cell.scene.step_s,
        arms=arms,
        frames=cell.frames,
        parts=cell.parts,
        bodies=cell.body_names,
        model=model,
        image_size=image.size,
        modules_at=image.modules.start,
        people=tuple(person.name for person in cell.people),
        bonds=tuple(cell.scene.bonds),
    )
