"""The RTDE port of the emulator: any bytes are answered or end the connection, and the arm stays where it is."""

from __future__ import annotations

import asyncio
from typing import Any, cast

from hypothesis import given
from hypothesis import strategies as st

from robots.drivers.universal_robots.emulator.link_faults import LinkFaults
from robots.drivers.universal_robots.emulator.rtde_server import RtdeServer, RtdeSession
from robots.drivers.universal_robots.emulator.ur_models import SERIES
from robots.drivers.universal_robots.rtde_codec import RecipeCodec, RtdePacket, split_packets
from tests.robots.drivers.universal_robots.emulator.urscript_execution import new_controller


class SentBytes(asyncio.Transport):
    """Keeps what is written."""

    def __init__(self) -> None:
        super().__init__()
        self.sent = bytearray()
        self.is_closed = False

    def write(self, data: Any) -> None:
        self.sent += cast("bytes", data)

    def is_closing(self) -> bool:
        return self.is_closed

    def close(self) -> None:
        self.is_closed = True

    def get_write_buffer_size(self) -> int:
        return 0


def new_session(server: RtdeServer) -> tuple[RtdeSession, SentBytes]:
    """Return a connected client."""
    session, transport = server.new_session(), SentBytes()
    session.connection_made(transport)
    return session, transport


def new_server() -> RtdeServer:
    """Return a server of a controller of the CB3 series."""
    return RtdeServer(new_controller(), SERIES["cb3"], LinkFaults())


def answers(session: RtdeSession, transport: SentBytes, *packets: RtdePacket) -> list[RtdePacket]:
    """Return the answers to some packets."""
    transport.sent.clear()
    session.data_received(b"".join(packet.encode() for packet in packets))
    return split_packets(transport.sent)


def packet(kind: str, payload: bytes = b"") -> RtdePacket:
    """Return a packet by its letter."""
    return RtdePacket(ord(kind), payload)


def test_an_input_has_one_owner_until_it_disconnects() -> None:
    """Who asks later is told that it is in use."""
    server = new_server()
    first, first_wire = new_session(server)
    second, second_wire = new_session(server)
    names = b"input_int_register_0,input_double_register_3,"
    assert answers(first, first_wire, packet("I", names)) == [packet("I", b"\x01INT32,DOUBLE")]
    assert answers(first, first_wire, packet("I", names)) == [packet("I", b"\x02INT32,DOUBLE")]
    assert answers(second, second_wire, packet("I", names)) == [packet("I", b"\x00IN_USE,IN_USE")]
    first.connection_lost(None)
    assert answers(second, second_wire, packet("I", names)) == [packet("I", b"\x01INT32,DOUBLE")]


async def due(delay_s: float) -> None:
    """Let the loop make all calls that are due by then."""
    passed = asyncio.Event()
    asyncio.get_running_loop().call_later(delay_s, passed.set)
    await passed.wait()


async def test_a_slow_link_keeps_the_order_of_packets_and_drops_those_of_a_client_that_has_gone() -> None:
    """As TCP does, also when it is slow no more."""
    server = new_server()
    session, wire = new_session(server)
    server.faults.delay_s = 0.05
    session.data_received(packet("V", b"\x00\x02").encode())
    server.faults.delay_s = 0.0
    session.data_received(packet("v").encode())
    await due(0.2)
    assert [each.kind for each in split_packets(bytearray(wire.sent))] == [ord("V"), ord("v")]
    server.faults.delay_s = 0.01
    wire.sent.clear()
    session.data_received(packet("v").encode())
    wire.close()
    await due(0.1)
    assert not wire.sent


def test_a_frequency_that_no_controller_has_is_refused() -> None:
    """The smallest double, which the control frequency divided by it is no number any more, and what is none itself."""
    server = new_server()
    session, wire = new_session(server)
    for frequency in (
        "0000000000000001",
        "0000000000000000",
        "7ff8000000000000",
        "7ff0000000000000",
        "408f400000000000",
    ):
        setup = bytes.fromhex(frequency) + b"timestamp"
        assert answers(session, wire, packet("O", setup)) == [packet("O", b"\x00DOUBLE")]


def test_outputs_are_sent_at_the_frequency_that_was_asked_for() -> None:
    """Not before the start; every other cycle at half of the control frequency."""
    server = new_server()
    session, wire = new_session(server)
    setup = bytes.fromhex("404f400000000000") + b"timestamp,robot_mode,"
    assert answers(session, wire, packet("O", setup)) == [packet("O", b"\x01DOUBLE,INT32")]
    wire.sent.clear()
    server.send_data(2)
    assert not wire.sent
    assert answers(session, wire, packet("S")) == [packet("S", b"\x01")]
    wire.sent.clear()
    for cycle in range(4):
        server.controller.run_cycle()
        server.send_data(cycle)
    data = [RecipeCodec(1, ["DOUBLE", "INT32"]).unpack(each.payload) for each in split_packets(wire.sent)]
    assert data == [[0.008, 7], [0.008 * 3, 7]]


def test_unknown_names_are_refused() -> None:
    """Each by itself, and the recipe as a whole."""
    session, wire = new_session(new_server())
    setup = bytes.fromhex("404f400000000000") + b"timestamp,output_int_register_48"
    assert answers(session, wire, packet("O", setup)) == [packet("O", b"\x00DOUBLE,NOT_FOUND")]
    assert answers(session, wire, packet("S")) == [packet("S", b"\x00")]


def test_data_of_the_wrong_length_change_nothing_and_are_answered() -> None:
    """With a message of the level of errors."""
    server = new_server()
    session, wire = new_session(server)
    answers(session, wire, packet("I", b"input_int_register_0"))
    (answer,) = answers(session, wire, packet("U", b"\x01\x00\x00\x00\x07\x00"))
    assert answer.kind == ord("M")
    assert answer.payload[-1] == 1
    assert server.controller.input_ints[0] == 0
    assert not answers(session, wire, packet("U", b"\x01\x00\x00\x00\x07"))
    assert server.controller.input_ints[0] == 7


KINDS = st.sampled_from(list(b"VvOISPUM")) | st.integers(0, 255)
PAYLOADS = st.binary(max_size=40) | st.sampled_from(
    [
        b"\x00\x02",
        b"timestamp,",
        b"input_int_register_0,",
        b"\x01\x00\x00\x00\x07",
        b"\x40\x5f\x40" + b"\0" * 5 + b"actual_q",
    ]
)
STREAMS = st.lists(st.builds(RtdePacket, KINDS, PAYLOADS), max_size=12).map(
    lambda packets: b"".join(each.encode() for each in packets)
)


@given(STREAMS | st.binary(max_size=200))
def test_any_bytes_are_answered_or_end_the_connection(stream: bytes) -> None:
    """What is sent are packets, the arm stays where it is, and the next client is served."""
    server = new_server()
    session, wire = new_session(server)
    before = server.controller.arm.q.copy()
    session.data_received(stream)
    for cycle in range(3):
        server.controller.run_cycle()
        server.send_data(cycle)
    split_packets(wire.sent)
    assert not wire.sent
    assert (server.controller.arm.q == before).all()
    session.connection_lost(None)
    other, other_wire = new_session(server)
    assert answers(other, other_wire, packet("I", b"input_int_register_0")) == [packet("I", b"\x01INT32")]
