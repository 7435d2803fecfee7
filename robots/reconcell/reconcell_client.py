"""The other side: commands a server of the interface and reads its state, with blocking sockets or none."""

from __future__ import annotations

import select
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Self

from engine.messages.primitives import CartDmp, CartOffsets, ForceReference, JointDmp
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.reconcell.control_mode import ControlMode
from robots.reconcell.packet_codec import decode_packet, encode_packet
from robots.reconcell.packet_errors import PacketRefused
from robots.reconcell.packet_table import SPECS, Family, state_ports
from robots.reconcell.packets import (
    KERNELS,
    OFFSET_CENTERS,
    DirectJoints,
    DmpExecution,
    DmpFlags,
    DmpHeader,
    KernelRow,
    LineGoal,
    ModeSelection,
    OutputBits,
    Packet,
    PhaseHold,
    RobotFlags,
    RobotStatePacket,
    ToolParameters,
    TrapezoidGoal,
)
from robots.reconcell.quaternion_order import QuaternionOrder, to_wire

_LONGEST = 2048
_UNUSED_VARIANCE = 0.0


class ReconcellClient:
    """Sends commands to one server and receives its state; poses are in the base of the arm.

    Args:
        server: IPv4 address of the server.
        own: IPv4 address to which the server sends the state; empty to receive none.
        source: IPv4 address to send from; empty for any.
        quaternion: Order of quaternions on the wire.
        capture: Captures its datagrams.
    """

    def __init__(
        self,
        server: str,
        *,
        own: str = "",
        source: str = "",
        quaternion: QuaternionOrder = "xyzw",
        capture: WireCapture = NO_CAPTURE,
    ) -> None:
        self._server = server
        self._own = own
        self._source = source
        self._order: QuaternionOrder = quaternion
        self._tap = capture.tap("reconcell")
        self._commands = DatagramSocket(self._tap)
        self._states: dict[int, DatagramSocket] = {}
        self._latest: dict[int, Packet] = {}
        self.sent = 0
        """Number of packets sent."""

    def __enter__(self) -> Self:
        self._commands.bind((self._source, 0))
        if self._own:
            for port in state_ports():
                receiver = DatagramSocket(self._tap)
                self._states[port] = receiver
                receiver.never_wait()
                receiver.bind((self._own, port))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._commands.close()
        for each in self._states.values():
            each.close()

    @property
    def state(self) -> RobotStatePacket | None:
        """The latest state that `receive` has read."""
        packet = self._latest.get(15000)
        return packet if isinstance(packet, RobotStatePacket) else None

    @property
    def flags(self) -> RobotFlags | None:
        """The latest flags that `receive` has read."""
        packet = self._latest.get(15001)
        return packet if isinstance(packet, RobotFlags) else None

    def primitive_flags(self, family: Family) -> DmpFlags | None:
        """Return the latest flags of joint or Cartesian primitives."""
        packet = self._latest.get(15006 if family == "joint_dmp" else 15005)
        return packet if isinstance(packet, DmpFlags) else None

    def receive(self, timeout_s: float = 0.0) -> Mapping[int, Packet]:
        """Read all state packets that have arrived, waiting for the first one; return the latest of each port."""
        ready = select.select([*self._states.values()], [], [], timeout_s)[0]
        while ready:
            for port, each in self._states.items():
                if each in ready:
                    self._latest[port] = decode_packet(port, each.receive(_LONGEST), direction="state")[1]
            ready = select.select([*self._states.values()], [], [], 0.0)[0]
        return dict(self._latest)

    def send(self, packet: Packet, port: int) -> None:
        """Send one packet."""
        self._commands.send(encode_packet(packet, port), (self._server, port))
        self.sent += 1

    def select(self, mode: ControlMode) -> None:
        """Select a mode, which starts what was sent before."""
        self.send(ModeSelection(mode=int(mode)), 10000)

    def stop(self) -> None:
        """End the motion under way. This byte is an extension of ours; the original server has none."""
        self.select(ControlMode.STOP)

    def move_joints(self, joints: Sequence[float], *, speed: float) -> None:
        """Start a trapezoidal motion."""
        self.send(TrapezoidGoal(joints=tuple(joints), speed=speed), 26000)
        self.select(ControlMode.JOINT_TRAPEZOID)

    def move_line(
        self, position_m: tuple[float, float, float], xyzw: tuple[float, float, float, float], *, duration_s: float
    ) -> None:
        """Start a line."""
        orientation = to_wire(xyzw, self._order)
        self.send(LineGoal(position_m=position_m, orientation=orientation, duration_s=duration_s), 27000)
        self.select(ControlMode.CART_LINE)

    def send_set_point(self, joints: Sequence[float]) -> None:
        """Send a set point of direct control; the first one before mode 4, all others after it."""
        self.send(DirectJoints(joints=tuple(joints)), 20000)

    def load_joint_dmp(self, dmp: JointDmp) -> None:
        """Send the parameters of a joint primitive; `tasktrans` has no packet."""
        _require_plain(dmp)
        self.send(_header(dmp, dmp.goal, dmp.y0), 25100)
        self._send_rows("joint_dmp", (dmp.c, dmp.sigma, *dmp.w))

    def load_cart_dmp(self, dmp: CartDmp) -> None:
        """Send the parameters of a Cartesian primitive in the base of the arm; `tasktrans` has no packet."""
        _require_plain(dmp)
        goal, y0 = (self._wire_pose(row) for row in (dmp.goal, dmp.y0))
        self.send(_header(dmp, goal, y0), 25000)
        self._send_rows("cart_dmp", (dmp.c, dmp.sigma, *dmp.weights))

    def load_offsets(self, offsets: CartOffsets) -> None:
        """Send adaptation offsets, at most 100 kernels."""
        if len(offsets.c_o) > OFFSET_CENTERS:
            raise PacketRefused("out of range", f"{len(offsets.c_o)} kernels of offsets, at most {OFFSET_CENTERS}")
        unused = (0.0,) * KERNELS
        self._send_rows("offset", (offsets.c_o, offsets.sigma_o, *offsets.weights, unused))

    def load_force(self, force: ForceReference) -> None:
        """Send the reference of forces and torques."""
        self._send_rows("force", (force.c_f, force.sigma_f, *force.weights))

    def execute(self, family: Family) -> None:
        """Execute the loaded primitive once its mode is selected."""
        self.send(DmpExecution(execute=1.0, reset=0.0), _port_of(family, DmpExecution))

    def reset(self, family: Family) -> None:
        """End the primitive under way; it can be executed again from its start."""
        self.send(DmpExecution(execute=0.0, reset=1.0), _port_of(family, DmpExecution))

    def stop_phase(self, family: Family, *, stopped: bool) -> None:
        """Let the phase of the primitive stand still, or go on."""
        self.send(PhaseHold(stopped=float(stopped)), _port_of(family, PhaseHold))

    def set_outputs(self, bits: int) -> None:
        """Set all digital outputs; output k is bit k."""
        self.send(OutputBits(value=float(bits)), 11000)

    def set_tool(self, tool: ToolParameters) -> None:
        """Send tool centre, mass and sensor offsets; the rotation in the order of the wire."""
        self.send(tool, 12000)

    def _send_rows(self, family: Family, rows: Sequence[Sequence[float]]) -> None:
        specs = [spec for spec in SPECS if spec.family == family and spec.row]
        for spec, row in zip(specs, rows, strict=True):
            length = spec.layouts[0].fields[0].count
            self.send(KernelRow(values=(*row, *[_UNUSED_VARIANCE] * (length - len(row)))), spec.port)

    def _wire_pose(self, row: Sequence[float]) -> tuple[float, ...]:
        x, y, z, *(a, b, c, d) = row
        return (x, y, z, *to_wire((a, b, c, d), self._order))


def _header(dmp: JointDmp | CartDmp, goal: tuple[float, ...], y0: tuple[float, ...]) -> DmpHeader:
    return DmpHeader(kernels=float(dmp.N), a_z=dmp.a_z, a_x=dmp.a_x, tau=dmp.tau, goal=goal, y0=y0, dy0=tuple(dmp.dy0))


def _require_plain(dmp: JointDmp | CartDmp) -> None:
    if dmp.tasktrans:
        raise PacketRefused("not supported", "no packet carries `tasktrans`", hint="apply it to the primitive first")


def _port_of(family: Family, packet: type[Packet]) -> int:
    return next(spec.port for spec in SPECS if spec.family == family and spec.packet is packet)
