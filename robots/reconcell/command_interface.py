"""Turns datagrams into skill calls: decoded, from one commander, complete, in order; all else is refused by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from engine.bus import GoalStatus, SkillBus
from engine.errors import BusError
from engine.messages import Pose, RobotDescription
from engine.messages.pose_algebra import compose_poses
from engine.skills.arm_control import SetEndEffectorFrame, SetLoad
from engine.skills.digital_outputs import DigitalOutputs, SetOutput
from engine.skills.dmp import CartAdmitDMP, CartDMP, Compliance, JointDMP
from engine.skills.guiding import GuideArm
from engine.skills.motion import CartLinTask, JointTrapVel
from robots.reconcell.commander import CommanderWatch, Sender
from robots.reconcell.control_mode import ControlMode
from robots.reconcell.interface_flags import InterfaceFlags, family_of
from robots.reconcell.interface_options import InterfaceOptions
from robots.reconcell.packet_codec import decode_packet
from robots.reconcell.packet_errors import PacketRefused
from robots.reconcell.packet_table import PacketSpec
from robots.reconcell.packets import (
    JOINTS,
    DirectJoints,
    DmpExecution,
    DmpHeader,
    Doubles,
    KernelRow,
    LineGoal,
    ModeSelection,
    OutputBits,
    Packet,
    PhaseHold,
    ToolParameters,
    TrapezoidGoal,
)
from robots.reconcell.primitive_parameters import KernelRows, PrimitiveParameters
from robots.reconcell.quaternion_order import from_wire
from robots.reconcell.reconcell_status import ReconcellStatus, RefusalCounter
from robots.reconcell.skill_calls import ArmCommands


@dataclass
class _CommandData:
    """What the commander has sent for its next motion."""

    joint_goal: TrapezoidGoal | None = None
    line_goal: LineGoal | None = None
    set_point: DirectJoints | None = None
    primitives: dict[str, PrimitiveParameters] = field(
        default_factory=lambda: {
            "joint_dmp": PrimitiveParameters("joint DMP"),
            "cart_dmp": PrimitiveParameters("Cartesian DMP"),
        }
    )
    offsets: KernelRows = field(default_factory=lambda: KernelRows("adaptation offset"))
    force: KernelRows = field(default_factory=lambda: KernelRows("force and torque profile"))
    selected: ControlMode = ControlMode.STOP
    armed: str = ""
    """The primitive whose execution flag came before its mode."""


class CommandInterface:
    """The commands to one arm, from whatever socket they come; used on the event loop only.

    Args:
        bus: The bus of the cell.
        description: The arm.
        options: The options.
        is_stopped: Whether the cell is stopped until an operator releases it.

    Raises:
        BusError: the arm has not six joints, which the packets are made for.
    """

    def __init__(
        self,
        bus: SkillBus,
        description: RobotDescription,
        *,
        options: InterfaceOptions,
        is_stopped: Callable[[], bool] = lambda: False,
    ) -> None:
        if len(description.joint_names) != JOINTS:
            raise BusError(
                f"{description.model} has {len(description.joint_names)} joints",
                where=description.name,
                hint=f"the packets of this interface carry {JOINTS}: choose another arm",
            )
        self._bus = bus
        self._arm = description
        self._options = options
        self._watch = CommanderWatch(identity=options.commander, release_s=options.release_s)
        self._data = _CommandData()
        self._refusals = RefusalCounter(description.name, bus.clock)
        self._received = 0
        self.flags = InterfaceFlags()
        self.commands = ArmCommands(
            bus,
            description.name,
            refuse=self._refuse,
            ended=self._ended,
            watchdog_s=options.watchdog_s,
            is_stopped=is_stopped,
        )

    @property
    def status(self) -> ReconcellStatus:
        """Who commands, and what was refused."""
        return ReconcellStatus(
            commander=self._watch.name,
            mode=int(self.commands.mode),
            received=self._received,
            refused=dict(self._refusals.counts),
            last_refusal=self._refusals.last,
        )

    def loaded_id(self, family: str) -> int:
        """Return the number of the complete primitive of a family; 0 for none."""
        return self._data.primitives[family].loaded_id

    def receive(self, port: int, data: bytes, sender: Sender) -> None:
        """Take a datagram; whatever is wrong with it is counted and logged."""
        self._received += 1
        try:
            spec, packet = decode_packet(port, data)
            now_s = self._bus.clock.now_s()
            if self._watch.admit(sender, now_s=now_s, in_motion=self._holds_command):
                self._data = _CommandData()
                self.commands.stop()
            self.flags.receive(spec)
            self._execute(spec, packet)
        except PacketRefused as refusal:
            self._refuse(refusal)

    def look(self) -> None:
        """Notice the silence of the commander and what the arm did by itself; called in every period."""
        commands, now_s = self.commands, self._bus.clock.now_s()
        commands.check()
        silence_s = self._watch.silence_s(now_s)
        limit_s = self._options.silence_s
        if commands.mode is ControlMode.DIRECT:
            limit_s = min(limit_s or self._options.release_s, self._options.release_s)
        if commands.moving and limit_s and silence_s > limit_s and not commands.ending:
            self._refuse(PacketRefused("silent commander", f"{self._watch.name} is silent for {silence_s:.2f} s"))
            commands.stop()
        self._watch.look(now_s=now_s, in_motion=self._holds_command)
        if commands.moving:
            self.flags.follow(commands.progress)

    @property
    def _holds_command(self) -> bool:
        """Whether what is under way keeps the command for a silent sender; direct control lives by set points."""
        return self.commands.moving and self.commands.mode is not ControlMode.DIRECT

    def _refuse(self, refusal: PacketRefused) -> None:
        self._refusals.count(refusal)

    def _ended(self, mode: ControlMode, status: GoalStatus) -> None:
        self.flags.end(mode, succeeded=status is GoalStatus.SUCCEEDED, failed=status is not GoalStatus.CANCELED)

    def _execute(self, spec: PacketSpec, packet: Packet) -> None:
        data = self._data
        match packet:
            case ModeSelection(mode=mode):
                self._select(ControlMode(mode))
            case DirectJoints(joints=joints):
                self._require_limits(joints)
                data.set_point = packet
                if self.commands.mode is ControlMode.DIRECT:
                    self.commands.send_direct(joints)
            case TrapezoidGoal(joints=joints):
                self._require_limits(joints)
                data.joint_goal = packet
            case LineGoal():
                data.line_goal = packet
            case DmpHeader():
                data.primitives[spec.family].begin(packet)
                data.armed = ""
            case KernelRow():
                self._take_row(spec, packet)
            case DmpExecution():
                self._execute_primitive(spec.family, packet)
            case PhaseHold(stopped=stopped):
                self._require_executed(spec.family)
                self.commands.hold(stopped=bool(stopped))
            case OutputBits(value=value):
                self._set_outputs(int(value))
            case ToolParameters():
                self._set_tool(packet)
            case _:
                raise PacketRefused("not supported", f"{spec.title} is no command")

    def _take_row(self, spec: PacketSpec, packet: KernelRow) -> None:
        data = self._data
        match spec.family:
            case "offset":
                data.offsets.take(spec.row, packet)
            case "force":
                data.force.take(spec.row, packet)
            case family:
                data.primitives[family].take(spec.row, packet)

    def _select(self, mode: ControlMode) -> None:
        data, commands = self._data, self.commands
        self.flags.received_mode = int(mode)
        if mode is ControlMode.STOP:
            data.selected, data.armed = mode, ""
            commands.stop()
            return
        if commands.mode is mode and (family_of(mode) or self._next_data(mode) is None):
            return  # the same byte again, as senders with a period repeat it
        if commands.moving:
            # Data whose mode was refused must not be those of a later one.
            data.joint_goal, data.line_goal, data.armed = None, None, ""
            raise PacketRefused("busy", f"{commands.mode.name} is under way", hint="end it by mode 0")
        data.selected = ControlMode.STOP
        if family_of(mode):
            self._require_primitive(mode)
            data.selected = mode
            if data.armed == family_of(mode):
                self._start_primitive(mode)
        elif mode is ControlMode.GUIDING:
            self._start(mode, GuideArm())
        else:
            self._start_with_data(mode)

    def _next_data(self, mode: ControlMode) -> Packet | None:
        """Return what was sent for the next motion of a mode."""
        data = self._data
        return {ControlMode.JOINT_TRAPEZOID: data.joint_goal, ControlMode.CART_LINE: data.line_goal}.get(mode)

    def _start_with_data(self, mode: ControlMode) -> None:
        """Start a motion with the data before it, which serves once."""
        data = self._data
        if mode is ControlMode.JOINT_TRAPEZOID and data.joint_goal is not None:
            goal, data.joint_goal = data.joint_goal, None
            self._start(mode, JointTrapVel(joints=goal.joints, speed=goal.speed))
        elif mode is ControlMode.CART_LINE and data.line_goal is not None:
            line, data.line_goal = data.line_goal, None
            x, y, z = line.position_m
            pose = Pose(xyz=(x, y, z), xyzw=from_wire(line.orientation, self._options.quaternion))
            self._start(mode, CartLinTask(pose=compose_poses(self._base, pose), duration_s=line.duration_s))
        elif mode is ControlMode.DIRECT and data.set_point is not None:
            point, data.set_point = data.set_point, None
            self.commands.start_direct(point.joints)
            self.flags.start(mode)
        else:
            raise PacketRefused(
                "no data", f"nothing was sent for mode {int(mode)}", hint="send the packet with its data, then the mode"
            )

    def _execute_primitive(self, family: str, flags: DmpExecution) -> None:
        data, commands = self._data, self.commands
        executes = commands.moving and family_of(commands.mode) == family
        self.flags.execution(family, execute=bool(flags.execute), reset=bool(flags.reset))
        if flags.reset or not flags.execute:
            data.armed = ""
            if executes:
                commands.stop()
            return
        if executes:
            return  # the same flag again
        selected = data.selected
        if family_of(selected) == family:
            self._start_primitive(selected)
            return
        data.primitives[family].require()
        data.armed = family

    def _require_executed(self, family: str) -> None:
        if not self.commands.moving or family_of(self.commands.mode) != family:
            raise PacketRefused("no data", "no primitive of this kind is executed")

    def _require_primitive(self, mode: ControlMode) -> None:
        self._data.primitives[family_of(mode)].require()
        if mode is ControlMode.ADMITTANCE:
            self._data.force.require()

    def _start_primitive(self, mode: ControlMode) -> None:
        self._require_primitive(mode)
        data = self._data
        data.armed = ""
        if mode is ControlMode.JOINT_DMP:
            joint = data.primitives["joint_dmp"].joint_dmp()
            self._start(mode, JointDMP(dmp=joint), a_x=joint.a_x)
            return
        cart = data.primitives["cart_dmp"].cart_dmp(base=self._base, order=self._options.quaternion)
        if mode is ControlMode.CART_DMP:
            self._start(mode, CartDMP(dmp=cart), a_x=cart.a_x)
            return
        force = data.force.force()
        x, y, z, a, b, c = (float(any(row)) for row in force.weights)
        goal = CartAdmitDMP(
            dmp=cart,
            offsets=data.offsets.offsets(),
            force=force,
            compliance=Compliance(active=(x, y, z, a, b, c), frame="base"),
        )
        self._start(mode, goal, a_x=cart.a_x)

    def _start(
        self, mode: ControlMode, goal: JointTrapVel | CartLinTask | JointDMP | CartDMP | CartAdmitDMP | GuideArm, *,
        a_x: float = 0.0,
    ) -> None:  # fmt: skip
        self.commands.start(mode, goal)
        self.flags.start(mode, a_x=a_x)

    def _require_limits(self, joints: Doubles) -> None:
        arm = self._arm
        for name, value, lower, upper in zip(arm.joint_names, joints, arm.lower_rad, arm.upper_rad, strict=True):
            if not lower <= value <= upper:
                raise PacketRefused(
                    "out of range", f"{name} at {value:.4g} rad", hint=f"from {lower:.4g} to {upper:.4g} rad"
                )

    @property
    def _base(self) -> Pose:
        """Where the base stands in the world now: an arm may pull it along."""
        latest = self._bus.find_topic(f"{self._arm.name}/description").latest
        return latest.base if isinstance(latest, RobotDescription) else self._arm.base

    def _set_outputs(self, bits: int) -> None:
        name = f"{self._arm.name}/digital_outputs"
        try:
            latest = self._bus.find_topic(name).latest
        except BusError:
            latest = None
        if not isinstance(latest, DigitalOutputs):
            raise PacketRefused("not supported", "the arm has no digital outputs")
        if bits >> len(latest.values):
            raise PacketRefused("out of range", f"bits {bits:b}", hint=f"the arm has {len(latest.values)} outputs")
        changes = [
            SetOutput(output=number, value=bool(bits >> number & 1))
            for number, value in enumerate(latest.values)
            if value != bool(bits >> number & 1)
        ]
        if changes:
            self.commands.call(*changes)

    def _set_tool(self, tool: ToolParameters) -> None:
        if any((*tool.force_offset_n, *tool.torque_offset_nm)):
            raise PacketRefused("not supported", "offsets of the sensor: the arm compensates them by itself")
        x, y, z = tool.xyz_m
        a, b, c = tool.com_m
        self.commands.call(
            SetEndEffectorFrame(xyz_m=(x, y, z), xyzw=from_wire(tool.orientation, self._options.quaternion)),
            SetLoad(mass_kg=tool.mass_kg, com_m=(a, b, c)),
        )
