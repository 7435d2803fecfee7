"""The server with a fake arm: what it refuses to serve, the order of datagrams, skills that an arm has not."""

from __future__ import annotations

import math
import select
import socket
import time
from collections.abc import Callable
from contextlib import ExitStack

import pytest

from engine.errors import FlexcellError
from engine.messages import RobotDescription
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.messages.primitives import CartOffsets, ForceReference
from engine.skills.motion import ForwardKinematics
from robots.io.wire.datagram_ports import DatagramPorts
from robots.model import model_by_name
from robots.reconcell import ControlMode, InterfaceOptions, PacketRefused, ReconcellClient, ReconcellServer
from robots.reconcell.command_interface import CommandInterface
from robots.reconcell.commander import Sender
from robots.reconcell.packet_codec import decode_packet
from robots.reconcell.packet_table import command_ports
from robots.reconcell.packets import KERNELS, KernelRow
from robots.reconcell.primitive_parameters import KernelRows
from robots.reconcell.reconcell_server import new_reconcell_server
from tests.robots.arm.served import served
from tests.robots.own_address import own_address
from tests.robots.reconcell.primitives_184 import cart_dmp


def read_all(
    sockets: DatagramPorts, take: Callable[[int, bytes, Sender], None], is_complete: Callable[[], bool]
) -> None:
    """Read until everything is there: on a busy machine datagrams are on their way for a moment."""
    end_s = time.monotonic() + 60.0
    while not is_complete():
        assert time.monotonic() < end_s
        select.select(sockets.filenos(), [], [], 1.0)
        sockets.read(take)


@pytest.mark.virtual
async def test_an_arm_without_six_joints_is_not_served() -> None:
    async with served() as cell:
        with pytest.raises(FlexcellError, match=r"panda has 7 joints.*choose another arm"):
            ReconcellServer(cell.bus, "left", InterfaceOptions())


@pytest.mark.virtual
async def test_an_address_of_the_network_a_senseless_option_and_a_wrong_name_are_refused() -> None:
    async with served(model=model_by_name("ur10")) as cell:
        for address in ("0.0.0.0", "192.168.0.1", "localhost", "::1"):
            with pytest.raises(FlexcellError, match="on this machine only"):
                ReconcellServer(cell.bus, "left", InterfaceOptions(address=address))
        for rate_hz in (0.0, -1.0, 1001.0, math.nan):
            with pytest.raises(FlexcellError, match="the rate is"):
                ReconcellServer(cell.bus, "left", InterfaceOptions(rate_hz=rate_hz))
        with pytest.raises(FlexcellError, match="no such topic"):
            ReconcellServer(cell.bus, "right", InterfaceOptions())
        with pytest.raises(FlexcellError, match="quaternion"):
            new_reconcell_server(cell.bus, "left", quaternion="zyxw")


def test_a_port_that_is_taken_is_named_and_the_others_are_given_back() -> None:
    address = own_address()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind((address, 26000))
        with pytest.raises(FlexcellError, match=f"cannot listen on {address}:26000"):
            DatagramPorts(address, command_ports())
    sockets = DatagramPorts(address, command_ports())
    sockets.close()


def test_datagrams_at_many_ports_are_taken_in_the_order_in_which_they_arrived() -> None:
    """A mode that is read before its data would start the motion of the data before."""
    address = own_address()
    sockets = DatagramPorts(address, command_ports())
    sent = [command_ports()[(number * 17) % 44] for number in range(200)]
    taken: list[tuple[int, bytes]] = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for number, port in enumerate(sent):
            sender.sendto(bytes([number]), (address, port))
        read_all(sockets, lambda port, data, _sender: taken.append((port, data)), lambda: len(taken) == len(sent))
    sockets.close()
    assert taken == [(port, bytes([number])) for number, port in enumerate(sent)]


@pytest.mark.virtual
async def test_a_cell_that_is_stopped_starts_nothing() -> None:
    async with served(model=model_by_name("ur10")) as cell:
        description = cell.bus.topic("left/description", RobotDescription).latest
        assert description is not None
        commands = CommandInterface(cell.bus, description, options=InterfaceOptions(), is_stopped=lambda: True)
        sender = ("127.0.0.1", 4000)
        commands.receive(20000, bytes(48), sender)
        commands.receive(10000, bytes([ControlMode.DIRECT]), sender)
        commands.receive(10000, bytes([ControlMode.GUIDING]), sender)
        await cell.bus.clock.sleep(0.1)
        assert commands.status.refused == {"cell is stopped": 2}
        assert cell.port.motion is None
        # This arm has no outputs.
        commands.receive(11000, bytes(8), sender)
        assert commands.status.refused == {"cell is stopped": 2, "not supported": 1}


@pytest.mark.virtual
async def test_client_and_server_agree_on_all_parameters() -> None:
    """Over sockets: what the client was given is what the rows hold, with kernels up to the first variance of 0."""
    address = own_address()
    rows = {"offset": KernelRows("offset"), "force": KernelRows("force")}
    offsets = CartOffsets(
        c_o=(0.9, 0.5), sigma_o=(0.1, 0.2), w1o=(1.0, 2.0), w2o=(3.0, 4.0), w3o=(5.0, 6.0),
        w4o=(7.0, 8.0), w5o=(9.0, 10.0), w6o=(11.0, 12.0),
    )  # fmt: skip
    force = ForceReference.constant(force_n=(1.0, 2.0, 3.0), torque_nm=(4.0, 5.0, 6.0))

    def take(port: int, data: bytes, _sender: object) -> None:
        spec, packet = decode_packet(port, data)
        assert isinstance(packet, KernelRow)
        rows[spec.family].take(spec.row, packet)

    with ExitStack() as stack:
        sockets = DatagramPorts(address, command_ports())
        stack.callback(sockets.close)
        client = stack.enter_context(ReconcellClient(address))
        client.load_offsets(offsets)
        client.load_force(force)
        read_all(sockets, take, lambda: not rows["force"].missing())
        with pytest.raises(PacketRefused, match="at most 100"):
            client.load_offsets(CartOffsets(
                c_o=(0.1,) * 101, sigma_o=(0.1,) * 101, w1o=(0.1,) * 101, w2o=(0.1,) * 101, w3o=(0.1,) * 101,
                w4o=(0.1,) * 101, w5o=(0.1,) * 101, w6o=(0.1,) * 101,
            ))  # fmt: skip
    assert rows["offset"].offsets() == offsets
    assert rows["force"].force() == force


def test_a_seventh_row_of_offsets_variances_of_zero_and_missing_centres_are_refused() -> None:
    offsets = KernelRows("offset")
    ones, zeros = KernelRow(values=(1.0,) * KERNELS), KernelRow(values=(0.0,) * KERNELS)
    assert offsets.offsets() is None
    for row in ("c", "sigma", "w1", "w2", "w3", "w4", "w5"):
        offsets.take(row, ones)
    with pytest.raises(PacketRefused, match="no w6"):
        offsets.offsets()
    offsets.take("w6", ones)
    offsets.take("w7", ones)
    with pytest.raises(PacketRefused, match="not supported"):
        offsets.offsets()
    offsets.take("w7", zeros)
    offsets.take("c", KernelRow(values=(0.5,) * 100))
    with pytest.raises(PacketRefused, match="184 variances, 100 centres"):
        offsets.offsets()
    offsets.take("sigma", zeros)
    with pytest.raises(PacketRefused, match="all variances are 0"):
        offsets.offsets()


@pytest.mark.virtual
async def test_the_axes_of_a_force_profile_are_compliant_along_the_base_and_offsets_are_given_on() -> None:
    address = own_address()
    force = ForceReference.constant(force_n=(0.0, 0.0, 5.0), torque_nm=(0.0, 0.1, 0.0))
    offsets = CartOffsets(
        c_o=(0.5,), sigma_o=(1.0,), w1o=(0.0,), w2o=(0.0,), w3o=(0.01,), w4o=(0.0,), w5o=(0.0,), w6o=(0.0,)
    )
    async with served(model=model_by_name("ur10")) as cell:
        description = cell.bus.topic("left/description", RobotDescription).latest
        assert description is not None
        commands = CommandInterface(cell.bus, description, options=InterfaceOptions())
        start = compose_poses(invert_pose(description.base), await cell.bus.call(ForwardKinematics(), to="left"))
        with ExitStack() as stack:
            sockets = DatagramPorts(address, command_ports())
            stack.callback(sockets.close)
            client = stack.enter_context(ReconcellClient(address))
            client.load_cart_dmp(cart_dmp(start, (0.0, 0.0, 0.03), detour_m=0.0))
            client.load_offsets(offsets)
            client.load_force(force)
            client.execute("cart_dmp")
            client.select(ControlMode.ADMITTANCE)
            read_all(sockets, commands.receive, lambda: commands.status.received == client.sent)
        await cell.bus.clock.sleep(1.0)
        assert commands.status.refused == {}
        (task,) = cell.port.tracked
        assert task.admittance.active == (0.0, 0.0, 1.0, 0.0, 1.0, 0.0)
        assert task.wrench[0] == pytest.approx((0.0, 0.0, 5.0, 0.0, 0.1, 0.0))
        assert task.offset[0] == pytest.approx((0.0, 0.0, 0.01, 0.0, 0.0, 0.0))
        await commands.commands.close()
