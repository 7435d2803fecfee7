"""The state packets of appendix A, made of what the bus says about the arm at one instant."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from engine.bus import SkillBus
from engine.errors import BusError, FlexcellError
from engine.messages import JointSetPoint, JointState, Quaternion, RobotDescription, Vector3, Wrench
from engine.messages.pose_algebra import compose_poses, invert_pose, rotate_vector
from engine.skills.arm_control import ArmStatus
from engine.skills.digital_inputs import DigitalInputs
from engine.skills.digital_outputs import DigitalOutputs
from engine.skills.motion import ForwardKinematics
from robots.reconcell.command_interface import CommandInterface
from robots.reconcell.packet_codec import encode_packet
from robots.reconcell.packets import Packet, RobotFlags, RobotStatePacket
from robots.reconcell.quaternion_order import QuaternionOrder, to_wire

T = TypeVar("T")

Datagram = tuple[int, bytes]
_STOPPED = {"disconnected", "fault", "reflex"}


@dataclass(frozen=True)
class _SetPoint:
    """A set point and its velocity."""

    time_s: float
    position_rad: tuple[float, ...]
    velocity_rad_s: tuple[float, ...]


class StateBroadcast:
    """Makes the packets; the velocity of the set point is that since the packets before.

    Args:
        bus: The bus of the cell.
        description: The arm.
        interface: Its commands, for the flags.
        order: Order of quaternions on the wire.
    """

    def __init__(
        self, bus: SkillBus, description: RobotDescription, interface: CommandInterface, *, order: QuaternionOrder
    ) -> None:
        self._bus = bus
        self._arm = description.name
        self._description = description
        self._interface = interface
        self._order: QuaternionOrder = order
        self._set_point: _SetPoint | None = None

    async def datagrams(self) -> tuple[Datagram, ...]:
        """Return the packets of now; of an arm that is not connected the flags only, as an old state is none."""
        state = await self._state()
        packets = {15000: state, **self._flags()}
        return tuple(
            (port, encode_packet(packet, port, direction="state"))
            for port, packet in packets.items()
            if packet is not None
        )

    async def _state(self) -> RobotStatePacket | None:
        joints, set_point, wrench = (
            self._latest("joint_state", JointState),
            self._latest("set_point", JointSetPoint),
            self._latest("wrench", Wrench),
        )
        if joints is None or set_point is None or wrench is None or not set_point.names or self._mode() in _STOPPED:
            self._set_point = None
            return None
        try:
            pose = await self._bus.call(ForwardKinematics(joints=joints.position_rad), to=self._arm)
        except FlexcellError:
            return None
        desired = self._with_velocity(set_point)
        # Where it stands now: an arm may pull its base along.
        to_base = invert_pose((self._latest("description", RobotDescription) or self._description).base)
        tool = compose_poses(to_base, pose)
        x, y, z, w = pose.xyzw
        outputs, inputs = self._latest("digital_outputs", DigitalOutputs), self._latest("digital_inputs", DigitalInputs)
        return RobotStatePacket(
            joints=joints.position_rad,
            desired_joints=desired.position_rad,
            velocity_rad_s=joints.velocity_rad_s,
            desired_velocity_rad_s=desired.velocity_rad_s,
            position_m=tool.xyz,
            orientation=to_wire(tool.xyzw, self._order),
            sensor_wrench=_turned(wrench, (-x, -y, -z, w)),
            tool_wrench=_turned(wrench, to_base.xyzw),
            outputs=_bits(outputs),
            inputs=_bits(inputs),
        )

    def _flags(self) -> dict[int, Packet]:
        interface = self._interface
        flags, commands = interface.flags, interface.commands
        pulses = flags.take_pulses()
        mode = self._mode()
        return {
            15001: RobotFlags(
                received_mode=flags.received_mode,
                sent_mode=int(commands.mode),
                idle=int(mode == "idle"),
                error=int(flags.error or mode in _STOPPED),
                running=int(commands.moving),
                received=int("any" in pulses),
                finished=int(flags.succeeded),
            ),
            15002: flags.direct(pulses),
            15003: flags.trapezoid(pulses),
            15004: flags.line(pulses),
            15005: flags.primitive("cart_dmp", pulses, loaded_id=interface.loaded_id("cart_dmp")),
            15006: flags.primitive("joint_dmp", pulses, loaded_id=interface.loaded_id("joint_dmp")),
        }

    def _with_velocity(self, now: JointSetPoint) -> _SetPoint:
        """Return the set point with its velocity since the packets before."""
        before = self._set_point
        if before is not None and now.time_s > before.time_s:
            span_s = now.time_s - before.time_s
            pairs = zip(now.position_rad, before.position_rad, strict=True)
            velocity = tuple((one - other) / span_s for one, other in pairs)
        else:
            velocity = before.velocity_rad_s if before is not None else (0.0,) * len(now.position_rad)
        self._set_point = _SetPoint(now.time_s, now.position_rad, velocity)
        return self._set_point

    def _mode(self) -> str:
        status = self._latest("status", ArmStatus)
        return status.mode if status is not None else "disconnected"

    def _latest(self, name: str, kind: type[T]) -> T | None:
        try:
            latest = self._bus.find_topic(f"{self._arm}/{name}").latest
        except BusError:
            return None
        return latest if isinstance(latest, kind) else None


def _turned(wrench: Wrench, by: Quaternion) -> tuple[float, ...]:
    force: Vector3 = rotate_vector(by, wrench.force_n)
    return (*force, *rotate_vector(by, wrench.torque_nm))


def _bits(state: DigitalOutputs | DigitalInputs | None) -> float:
    """Return the values as the bits of a number."""
    values = state.values if state is not None else ()
    return float(sum(1 << number for number, value in enumerate(values) if value))
