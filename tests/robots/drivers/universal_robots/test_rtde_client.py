"""The RTDE client against a controller that answers as a test says: versions, owners of inputs, garbage, silence."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager

import pytest

from robots.drivers.arm.joint_controller import ControllerLost
from robots.drivers.universal_robots.rtde_client import RtdeClient, RtdeInputsInUse, RtdeVersionError
from robots.drivers.universal_robots.rtde_codec import (
    RecipeCodec,
    RtdePacket,
    RtdePacketType,
    recipe_reply,
    split_packets,
)
from robots.drivers.universal_robots.ur_options import UrOptions, UrPorts
from robots.drivers.universal_robots.ur_script_controller import UrScriptController
from robots.io.wire.link_error import LinkError

LIMIT_S = 20.0
VERSION = bytes.fromhex("00000003 0000000f 00000008 00019f63")
Answers = Callable[[RtdePacket], bytes]


def controller_of(
    *, protocol: bytes = b"\x01", outputs: bytes = b"", inputs: bytes = b"", behind_start: bytes = b""
) -> Answers:
    """Return what a controller answers."""

    def answer(packet: RtdePacket) -> bytes:
        payload = {
            RtdePacketType.PROTOCOL_VERSION: protocol,
            RtdePacketType.CONTROLLER_VERSION: VERSION,
            RtdePacketType.SETUP_OUTPUTS: outputs,
            RtdePacketType.SETUP_INPUTS: inputs,
            RtdePacketType.START: b"\x01",
        }[RtdePacketType(packet.kind)]
        sent = RtdePacket(packet.kind, payload).encode()
        return sent + behind_start if packet.kind == RtdePacketType.START else sent

    return answer


@contextmanager
def served(answers: Answers) -> Generator[int]:
    """Serve one client, and return the port."""
    listener = socket.create_server(("127.0.0.1", 0))

    def serve() -> None:
        client, _ = listener.accept()
        received = bytearray()
        with client:
            while data := client.recv(1000):
                received += data
                for packet in split_packets(received):
                    client.sendall(answers(packet))

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        yield int(listener.getsockname()[1])
    finally:
        thread.join(LIMIT_S)
        listener.close()


@contextmanager
def connected(answers: Answers) -> Generator[RtdeClient]:
    """A client of such a controller."""
    with served(answers) as port:
        client = RtdeClient("127.0.0.1", port, limit_s=LIMIT_S)
        try:
            client.connect()
            yield client
        finally:
            client.close()


def test_a_controller_of_another_protocol_is_a_wrong_version() -> None:
    with pytest.raises(RtdeVersionError, match="protocol 2"), connected(controller_of(protocol=b"\x00")):
        pass


def test_a_controller_without_a_variable_is_a_wrong_version_and_says_which() -> None:
    """Of the driver too."""
    answers = controller_of(outputs=recipe_reply(0, ["DOUBLE", "NOT_FOUND"]))
    with connected(answers) as client, pytest.raises(RtdeVersionError, match="offers no speed_scaling"):
        client.choose_outputs(["timestamp", "speed_scaling"], optional=[], frequency_hz=125.0)
    with served(controller_of(protocol=b"\x00")) as port:
        options = UrOptions(host="127.0.0.1", client="script", ports=UrPorts(rtde=port))
        controller = UrScriptController(options)
        with pytest.raises(ControllerLost, match=r"^wrong version: ") as refused:
            controller.connect()
        assert "PolyScope 3.5" in refused.value.hint
        controller.close()


def test_an_optional_variable_may_be_missing() -> None:
    asked: list[RtdePacket] = []

    def answers(packet: RtdePacket) -> bytes:
        if packet.kind == RtdePacketType.SETUP_OUTPUTS:
            asked.append(packet)
            has_both = packet.payload.endswith(b"payload")
            reply = recipe_reply(0, ["DOUBLE", "NOT_FOUND"]) if has_both else recipe_reply(1, ["DOUBLE"])
            return RtdePacket(packet.kind, reply).encode()
        return controller_of()(packet)

    with connected(answers) as client:
        assert client.choose_outputs(["timestamp"], optional=["payload"], frequency_hz=125.0) == ("timestamp",)
    assert [packet.payload[8:] for packet in asked] == [b"timestamp,payload", b"timestamp"]


def test_an_input_of_another_client_is_named() -> None:
    answers = controller_of(inputs=recipe_reply(0, ["INT32", "IN_USE"]))
    with connected(answers) as client, pytest.raises(RtdeInputsInUse, match="another client writes input_b"):
        client.own_inputs(["input_a", "input_b"], ["INT32", "INT32"])


def test_of_many_outputs_the_last_is_returned() -> None:
    codec = RecipeCodec(1, ["DOUBLE"])
    data = b"".join(codec.pack([float(number)]).encode() for number in range(50))
    answers = controller_of(outputs=recipe_reply(1, ["DOUBLE"]), behind_start=data)
    with connected(answers) as client:
        client.choose_outputs(["timestamp"], optional=[], frequency_hz=125.0)
        client.start()
        last = 0.0
        while last < 49.0:
            values = client.latest(LIMIT_S)
            assert values is not None
            (value,) = values
            assert isinstance(value, float)
            assert value > last
            last = value
        assert client.latest(0.01) is None


@pytest.mark.parametrize(
    ("sent", "error"),
    [
        (bytes(40), "header alone has 3"),
        (RtdePacket(RtdePacketType.DATA, b"\x01\x00").encode(), "have 2 bytes; the recipe has 9"),
    ],
)
def test_what_is_no_data_is_an_error_by_name(sent: bytes, error: str) -> None:
    answers = controller_of(outputs=recipe_reply(1, ["DOUBLE"]), behind_start=sent)
    with connected(answers) as client:
        client.choose_outputs(["timestamp"], optional=[], frequency_hz=125.0)
        with pytest.raises(LinkError, match=error):
            _start_and_read(client)


def _start_and_read(client: RtdeClient) -> None:
    client.start()
    client.latest(LIMIT_S)


def test_a_controller_that_takes_nothing_is_not_waited_for() -> None:
    """Inputs are left out while it hangs, and no half of a packet is lost when it goes on."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        client = RtdeClient("127.0.0.1", int(listener.getsockname()[1]), limit_s=LIMIT_S)

        def serve() -> socket.socket:
            connection, _ = listener.accept()
            received = bytearray()
            for _ in range(3):
                packets: list[RtdePacket] = []
                while not packets:
                    received += connection.recv(1000)
                    packets = split_packets(received)
                connection.sendall(controller_of(inputs=recipe_reply(1, ["DOUBLE"] * 20))(packets[0]))
            return connection

        peers: list[socket.socket] = []
        thread = threading.Thread(target=lambda: peers.append(serve()))
        thread.start()
        client.connect()
        client.own_inputs(["input"] * 20, ["DOUBLE"] * 20)
        thread.join(LIMIT_S)
        begun_s = time.process_time()
        for number in range(60_000):
            client.write([float(number)] * 20)
        assert time.process_time() - begun_s < LIMIT_S
        received, last = bytearray(), -1.0
        codec = RecipeCodec(1, ["DOUBLE"] * 20)
        with peers[0] as peer:
            peer.settimeout(0.5)
            for number in range(100_000):
                try:
                    received += peer.recv(1_000_000)
                except TimeoutError:
                    break
                for packet in split_packets(received):
                    (value, *_) = codec.unpack(packet.payload)
                    assert isinstance(value, float)
                    assert value > last
                    last = value
                client.write([float(60_000 + number)] * 20)
                if last >= 60_000.0:
                    break
            assert last >= 60_000.0
        client.close()
