"""Clients and servers that freeze, die or talk nonsense: measured at the pins of an emulated pigpiod."""

from __future__ import annotations

import signal
import socket
import time
from collections.abc import Generator
from pathlib import Path

import pytest

from engine.errors import RobotError
from robots.drivers.equipment.wire.equipment_client import connected
from robots.io.wire.link_error import LinkError
from tests.robots.drivers.emulated_device import EmulatedProcess, emulated_device
from tests.robots.drivers.equipment.served_equipment import PINS, doomed_client, served_equipment, waited_for

CLAMP, VALVE, THERE = 17, 22, 27
SAFE_WITHIN_S = 0.3


@pytest.fixture
def pigpiod() -> Generator[EmulatedProcess]:
    """Start an emulated pigpiod."""
    with emulated_device("pigpiod") as device:
        yield device


@pytest.fixture
def document(pigpiod: EmulatedProcess, tmp_path: Path) -> Path:
    """Write a document for it."""
    file = tmp_path / "clamps.yaml"
    place = pigpiod.place
    backend = f"{{kind: gpiozero, factory: pigpio, host: {place['host']}, port: {place['port']}}}"
    file.write_text(f"flexcell: 1\nequipment: clamps\nbackend: {backend}\n{PINS}", encoding="utf-8")
    return file


def levels(device: EmulatedProcess) -> tuple[int, int]:
    """Return the levels of clamp and valve; safe are (0, 0), as the clamp is on at the low level."""
    return device.do("state", pin=CLAMP)["level"], device.do("state", pin=VALVE)["level"]


def changed_s(device: EmulatedProcess) -> float:
    """Return when the last of both pins has changed, on the monotonic clock of this machine."""
    return max(device.do("state", pin=pin)["changed_s"] for pin in (CLAMP, VALVE))


def test_pins_are_set_read_back_and_read(pigpiod: EmulatedProcess, document: Path) -> None:
    """By the name of the service, with the level that the document says."""
    with served_equipment(document) as server, connected(server.host, server.port, name="test", control=True) as client:
        assert levels(pigpiod) == (0, 0)
        client.set({"clamp": False, "valve": True})
        assert levels(pigpiod) == (1, 1)
        pigpiod.do("level", pin=THERE, on=True)
        assert waited_for(lambda: client.read().values["there"] is True)
        assert client.read().values == {"clamp": False, "valve": True, "there": True}


@pytest.mark.parametrize("number", [signal.SIGSTOP, signal.SIGKILL])
def test_outputs_of_a_frozen_or_killed_client_are_safe_in_time(
    pigpiod: EmulatedProcess, document: Path, number: signal.Signals
) -> None:
    """And stay so when it goes on."""
    with served_equipment(document) as server, doomed_client(server) as client:
        assert levels(pigpiod) == (1, 1)
        sent_s = time.monotonic()
        client.send_signal(number)
        assert waited_for(lambda: levels(pigpiod) == (0, 0))
        assert changed_s(pigpiod) - sent_s <= SAFE_WITHIN_S
        client.send_signal(signal.SIGCONT)
        client.wait(20.0)
        assert levels(pigpiod) == (0, 0)


def test_the_end_of_the_server_is_safe(pigpiod: EmulatedProcess, document: Path) -> None:
    """SIGTERM while a client controls."""
    with served_equipment(document) as server, doomed_client(server):
        server.process.terminate()
        server.process.wait(20.0)
        assert levels(pigpiod) == (0, 0)


def test_a_killed_server_is_safe_when_it_is_started_again(pigpiod: EmulatedProcess, document: Path) -> None:
    """It cannot act any more when it is killed; nothing that was set returns."""
    with served_equipment(document) as server, doomed_client(server) as client:
        server.process.kill()
        server.process.wait(20.0)
        client.wait(20.0)
    with served_equipment(document) as server, connected(server.host, server.port, name="test") as reader:
        assert levels(pigpiod) == (0, 0)
        assert reader.read().controller == ""


def test_a_cut_to_pigpiod_ends_the_control_and_nothing_returns(pigpiod: EmulatedProcess, document: Path) -> None:
    """The pins are read again by themselves, at their safe values."""
    with served_equipment(document) as server:
        with connected(server.host, server.port, name="test", control=True) as client:
            client.set({"valve": True})
            pigpiod.do("cut")
            with pytest.raises(RobotError, match="control was lost"):
                waited_for(lambda: bool(client.read().sequence < 0))
        with connected(server.host, server.port, name="reader") as reader:
            assert waited_for(lambda: reader.read().problem != "")
            assert reader.read().values == {}
            pigpiod.do("restore")
            assert waited_for(lambda: reader.read().problem == "")
            assert reader.read().values == {"clamp": True, "valve": False, "there": False}
    assert levels(pigpiod) == (0, 0)


@pytest.mark.parametrize("fault", ["freeze", "garbage", "refuse"])
def test_a_pigpiod_that_answers_nothing_or_nonsense_is_no_value(
    pigpiod: EmulatedProcess, document: Path, fault: str
) -> None:
    """Commands fail with the reason; after the fault all is safe."""
    with served_equipment(document) as server, connected(server.host, server.port, name="reader") as reader:
        with connected(server.host, server.port, name="test", control=True) as client:
            pigpiod.do(fault)
            with pytest.raises(RobotError):
                client.set({"valve": True})
        assert waited_for(lambda: reader.read().problem != "")
        pigpiod.do("restore")
        assert waited_for(lambda: reader.read().problem == "")
        assert waited_for(lambda: levels(pigpiod) == (0, 0))


def test_garbage_of_a_client_ends_its_connection_only(pigpiod: EmulatedProcess, document: Path) -> None:
    """The client that controls goes on."""
    with served_equipment(document) as server, connected(server.host, server.port, name="test", control=True) as client:
        client.set({"valve": True})
        for garbage in (b"\xff" * 64, b"GET / HTTP/1.1\r\n\r\n", b"\x03\x00\x00\x00\x01\x00\x00\x00abc"):
            with socket.create_connection((server.host, server.port), 5.0) as other:
                other.sendall(garbage)
                client.read()
                while other.recv(4096):
                    client.read()
        assert levels(pigpiod) == (0, 1)
        assert client.read().values["valve"] is True


def test_a_server_that_is_gone_is_named(document: Path) -> None:
    """By the client."""
    with served_equipment(document) as server, connected(server.host, server.port, name="test") as client:
        server.process.kill()
        with pytest.raises(LinkError, match="has closed the connection"):
            waited_for(lambda: client.read().sequence < 0)
