"""What an HTTP service sends is captured also where it is no HTTP, and how the connection ended."""

from __future__ import annotations

import socket
import threading

import pytest

from robots.drivers.abb.abb_faults import AbbFault, AbbLinkError
from robots.drivers.abb.rws.rws_client import RwsClient
from robots.io.wire.wire_tap import WireEvent, WireTap


@pytest.mark.parametrize(
    ("answer", "fault", "end"),
    [
        # Nothing more is read of what is no HTTP.
        (b"SSH-2.0 no web server\r\n\r\n", AbbFault.GARBAGE, ["closed"]),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\n{", AbbFault.GARBAGE, ["ended", "closed"]),
        (b"", AbbFault.LINK_CUT, ["ended", "closed"]),
    ],
)
def test_all_bytes_and_the_end_are_noted(answer: bytes, fault: AbbFault, end: list[str]) -> None:
    events: list[WireEvent] = []
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            client, _ = server.accept()
            with client:
                client.recv(4096)
                client.sendall(answer)

        serving = threading.Thread(target=serve)
        serving.start()
        host, port = server.getsockname()
        client = RwsClient(host, port, user="u", password="an example", timeout_s=5.0, tap=WireTap(events.append))
        with pytest.raises(AbbLinkError) as refused:
            client.get("/rw/system")
        client.close()
        serving.join()
    assert refused.value.fault is fault
    assert b"".join(each.data for each in events if each.kind == "received") == answer
    assert events[0].kind == "opened"
    assert events[0].endpoints is not None
    assert events[0].endpoints.remote == (host, port)
    assert [each.kind for each in events if each.kind in ("ended", "closed")] == end
