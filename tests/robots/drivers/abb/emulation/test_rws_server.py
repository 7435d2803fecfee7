"""The web server of the emulated controller: who may ask, and what is no request."""

from __future__ import annotations

import numpy as np
import pytest

from robots.drivers.abb.emulation.controller_panel import ControllerPanel
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.emulation.emulated_signals import EmulatedSignals
from robots.drivers.abb.emulation.rws_resources import RwsResources
from robots.drivers.abb.emulation.rws_server import RwsServer
from robots.drivers.emulation.wire_faults import WireFaults


@pytest.fixture
def server() -> RwsServer:
    """A server that does not listen."""
    controller = EmulatedController(lambda: 0.0, axes=np.zeros(6), stop_s=0.2)
    resources = RwsResources(controller, ControllerPanel(controller), EmulatedSignals(["diDoor"]))
    return RwsServer(resources, WireFaults(), host="127.0.0.1", port=0, user="user", password="secret")


@pytest.mark.parametrize(
    "authorization",
    [
        "",
        "Authorization: Basic dXNlcjpzZWNyZXQ=\r\n",
        'Authorization: Digest username="user", response="0"\r\n',
        'Authorization: Digest username="user", nonce="{nonce}", uri="/rw/system", response="\xe9"\r\n',
    ],
)
def test_who_does_not_know_the_password_is_not_answered(server: RwsServer, authorization: str) -> None:
    challenge = server.answer(b"GET /rw/system HTTP/1.1\r\n\r\n", b"").decode()
    nonce = challenge.partition('nonce="')[2].partition('"')[0]
    head = f"GET /rw/system HTTP/1.1\r\n{authorization.format(nonce=nonce)}\r\n".encode("latin-1")
    assert server.answer(head, b"").startswith(b"HTTP/1.1 401 ")
    assert server.requests == 0
