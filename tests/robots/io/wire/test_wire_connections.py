"""What drivers open: each notes what was sent and received, and a capture that ends does not touch the connection."""

from __future__ import annotations

import os
import socket
import time
import tty
from pathlib import Path

import pytest

from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.link_error import LinkError
from robots.io.wire.pending_connection import PendingConnection
from robots.io.wire.serial_stream import SerialStream
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_capture import WireCapture
from robots.io.wire.wire_tap import WireEndpoints, WireEvent, WireTap


class Noted(list[WireEvent]):
    """Events of one connection."""

    def tap(self) -> WireTap:
        return WireTap(self.append)

    @property
    def what(self) -> list[tuple[str, bytes]]:
        return [(event.kind, event.data) for event in self]


def test_a_tcp_connection_notes_what_it_says_and_who_ended_it() -> None:
    noted = Noted()
    with socket.create_server(("127.0.0.1", 0)) as server:
        connection = TcpConnection(server.getsockname(), timeout_s=5.0, tap=noted.tap())
        device, address = server.accept()
        connection.send(b"ask")
        assert device.recv(100) == b"ask"
        device.sendall(b"answer")
        assert connection.receive(100) == b"answer"
        device.close()
        assert connection.receive(100) == b""
        connection.close()
        expected = WireEndpoints(local=address, remote=server.getsockname())
    assert {event.endpoints for event in noted} == {expected}
    assert noted.what == [("opened", b""), ("sent", b"ask"), ("received", b"answer"), ("ended", b""), ("closed", b"")]
    assert [event.time_ns for event in noted] == sorted(event.time_ns for event in noted)


def test_what_a_connection_does_not_take_at_once_is_neither_waited_for_nor_noted() -> None:
    noted = Noted()
    with socket.create_server(("127.0.0.1", 0)) as server:
        connection = TcpConnection(server.getsockname(), timeout_s=5.0, tap=noted.tap())
        device, _ = server.accept()
        piece, taken = bytes(range(256)) * 256, 0
        while sent := connection.send_some(piece[taken % len(piece) :]):
            taken += sent
        assert b"".join(event.data for event in noted if event.kind == "sent") == (piece * (taken // 65536 + 1))[:taken]
        assert not connection.has_bytes()
        device.close()
        connection.close()


def test_a_connection_that_is_begun_is_there_once_the_device_takes_it() -> None:
    noted = Noted()
    with socket.create_server(("127.0.0.1", 0)) as server:
        pending = PendingConnection(server.getsockname(), tap=noted.tap())
        device, address = server.accept()
        while (connection := pending.connected()) is None:
            pass
        device.sendall(b"state")
        while not connection.has_bytes():
            pass
        assert connection.receive(100) == b"state"
        device.close()
        while not connection.has_bytes():
            pass
        assert connection.receive(100) == b""
        connection.close()
        expected = WireEndpoints(local=address, remote=server.getsockname())
    assert {event.endpoints for event in noted} == {expected}
    assert noted.what == [("opened", b""), ("received", b"state"), ("ended", b""), ("closed", b"")]


def test_what_fails_to_connect_is_noted_as_nothing() -> None:
    noted = Noted()
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        with pytest.raises(OSError, match="refused"):
            TcpConnection(unused.getsockname(), timeout_s=1.0, tap=noted.tap())
    assert noted == []


def test_datagrams_have_their_addresses() -> None:
    noted = Noted()
    ours = DatagramSocket(noted.tap())
    ours.bind(("127.0.0.1", 0))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as device:
        device.bind(("127.0.0.1", 0))
        ours.send(b"ask", device.getsockname())
        data, own = device.recvfrom(100)
        device.sendto(data + b"!", own)
        assert ours.receive(100) == b"ask!"
        expected = WireEndpoints(local=own, remote=device.getsockname())
    ours.close()
    assert [(event.kind, event.data, event.endpoints) for event in noted] == [
        ("sent", b"ask", expected),
        ("received", b"ask!", expected),
    ]


def test_a_line_through_a_socket_is_read_as_a_whole() -> None:
    """pyserial reads it byte by byte."""
    noted = Noted()
    with socket.create_server(("127.0.0.1", 0)) as server:
        host, port = server.getsockname()
        line = SerialStream(f"socket://{host}:{port}", baud=115200, timeout_s=1.0, tap=noted.tap())
        line.open()
        device, _ = server.accept()
        device.sendall(b"READY\n")
        assert line.read(time.monotonic() + 5.0) == b"READY\n"
        line.write(b"?\n")
        assert device.recv(100) == b"?\n"
        device.close()
        with pytest.raises(LinkError, match="the serial line failed: socket disconnected"):
            line.read(time.monotonic() + 5.0)
        line.close()
    assert noted.what == [("opened", b""), ("received", b"READY\n"), ("sent", b"?\n"), ("ended", b""), ("closed", b"")]
    assert noted[0].endpoints is not None
    assert noted[0].endpoints.remote == (host, port)


def test_a_serial_device_has_no_addresses() -> None:
    noted = Noted()
    ours, theirs = os.openpty()
    for end in (ours, theirs):
        tty.setraw(end)
    line = SerialStream(os.ttyname(theirs), baud=115200, timeout_s=1.0, tap=noted.tap())
    line.open()
    line.write(b"?\n")
    assert os.read(ours, 100) == b"?\n"
    line.close()
    os.close(ours)
    os.close(theirs)
    assert [(event.kind, event.endpoints) for event in noted] == [("opened", None), ("sent", None), ("closed", None)]


def test_a_capture_without_its_folder_leaves_the_connection_alone(tmp_path: Path) -> None:
    capture = WireCapture(tmp_path / "gone", device="arm")
    with socket.create_server(("127.0.0.1", 0)) as server:
        connection = TcpConnection(server.getsockname(), timeout_s=5.0, tap=capture.tap("lines"))
        device, _ = server.accept()
        for number in range(50):
            connection.send(bytes([number]))
        capture.close()
        connection.send(b"on")
        received = b""
        while not received.endswith(b"on"):
            received += device.recv(100)
        assert received == bytes(range(50)) + b"on"
        device.close()
        connection.close()
    assert not (tmp_path / "gone").exists()
