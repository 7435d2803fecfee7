"""Robot Web Services and Externally Guided Motion: the emulated controller is fed, and the codecs of its driver."""

from __future__ import annotations

import hashlib
import socket
import threading
from collections.abc import Callable
from contextlib import suppress

import msgspec
import numpy as np

from benchmarks.fuzz_target import FuzzTarget
from robots.drivers.abb.abb_faults import AbbLinkError
from robots.drivers.abb.egm.egm_messages import (
    EgmMeasurement,
    EgmSetPoint,
    MciState,
    MotorState,
    RapidState,
    decode_measurement,
    encode_measurement,
    encode_set_point,
)
from robots.drivers.abb.egm.egm_socket import EgmSocket
from robots.drivers.abb.emulation.controller_panel import ControllerPanel
from robots.drivers.abb.emulation.egm_source import EgmSource
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.emulation.emulated_signals import EmulatedSignals
from robots.drivers.abb.emulation.rws_resources import RwsResources
from robots.drivers.abb.emulation.rws_server import RwsServer
from robots.drivers.abb.rws.rws_client import RwsClient
from robots.drivers.abb.rws.rws_state import (
    SignalUnknown,
    digital_signal,
    error_text,
    latest_error,
    mode_selector,
    panel_state,
    rapid_execution,
    rws_identity,
    speed_share,
)
from robots.drivers.abb.rws.rws_transport import RwsTransport
from robots.drivers.emulation.plant import RealClock
from robots.drivers.emulation.wire_faults import WireFaults
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.wire_tap import NO_TAP

_ANGLES = (1.0, -2.0, 0.0, 0.5, 0.0, 180.0)
_DRIVER = ("127.9.9.9", 6510)
_LIMIT_S = 0.05
_MOST_BYTES = 65536
_PATHS = ("/rw/panel/ctrlstate", "/rw/rapid/execution", "/rw/elog/0", "/ctrl/identity", "/rw/nothing")
_SIGNAL = "diDoor"
_READ = (*_PATHS[:4], f"/rw/iosystem/signals/{_SIGNAL}")


def egm_codec() -> FuzzTarget:
    """Measurements of a controller."""
    running = EgmMeasurement(
        number=7,
        time_ms=28,
        measured_deg=_ANGLES,
        planned_deg=_ANGLES,
        motors=MotorState.ON,
        mci=MciState.RUNNING,
        rapid=RapidState.RUNNING,
    )
    plain = EgmMeasurement(number=2**32 - 1, time_ms=0, measured_deg=_ANGLES)

    def feed(packet: bytes) -> str:
        try:
            decode_measurement(packet)
        except AbbLinkError as error:
            return error.fault.value
        return ""

    return FuzzTarget(
        "egm", "to the driver", (encode_measurement(running), encode_measurement(plain)), feed, lambda: False
    )


def egm() -> FuzzTarget:
    """A controller whose guided motion has not begun, so that it follows nothing."""
    controller, panel = _controller()
    source = EgmSource(controller, panel, WireFaults(), client=None, clock=RealClock(), stop_s=0.2, comm_timeout_s=0.2)
    valid = tuple(encode_set_point(EgmSetPoint(number=n, time_ms=4 * n, planned_deg=_ANGLES)) for n in (1, 2**31))

    def feed(packet: bytes) -> str:
        source.take(packet)
        return "ignored"

    return FuzzTarget("egm", "to the device", valid, feed, lambda: source.heard > 0 or controller.travel_rad > 0.0)


def egm_socket() -> FuzzTarget:
    """The port of the driver, which takes the newest measurement and answers where it came from."""
    controller = DatagramSocket(NO_TAP)
    controller.bind(("127.0.0.1", 0))
    controller.never_wait()
    # An address of its own, so that the usual port is free.
    driver = EgmSocket("127.0.0.1", address=_DRIVER[0], port=_DRIVER[1])

    def feed(packet: bytes) -> str:
        # Opened anew it takes any number.
        driver.open()
        try:
            controller.send(packet, _DRIVER)
            if driver.receive(0.0) is None:
                return "garbage" if driver.garbage else "late or twice"
            driver.send(_ANGLES)
            controller.receive(_MOST_BYTES)
        finally:
            driver.close()
        return ""

    return FuzzTarget("egm transport", "to the driver", egm_codec().valid, feed, lambda: False, 0.01)


def rws_transport() -> FuzzTarget:
    """The HTTP client of the driver: each reading gets one answer, and the connection is closed."""
    resources = RwsResources(*_controller(), EmulatedSignals([_SIGNAL]))
    bodies = [msgspec.json.encode({"_embedded": {"_state": resources.read(path)}}) for path in _READ]
    heads = [f"HTTP/1.1 200 OK\r\nContent-Length: {len(body)}\r\n\r\n".encode() for body in bodies]
    challenge = b'HTTP/1.1 401 No\r\nWWW-Authenticate: Digest realm="r", qop="auth", nonce="n"\r\n\r\n'
    valid = (*(head + body for head, body in zip(heads, bodies, strict=True)), challenge)
    server = socket.create_server(("127.0.0.1", 0))
    host, port = server.getsockname()
    answers = [b""]

    def serve() -> None:
        while True:
            client, _ = server.accept()
            with client, suppress(OSError):
                client.recv(_MOST_BYTES)
                client.sendall(answers[0])

    threading.Thread(target=serve, daemon=True).start()

    def feed(packet: bytes) -> str:
        answers[0] = packet
        client = RwsClient(host, port, user="user", password="password", timeout_s=_LIMIT_S)
        transport = RwsTransport("fuzz", lambda: client, signals=[_SIGNAL])
        transport.open()
        try:
            transport.read()
        except AbbLinkError as error:
            return error.fault.value
        finally:
            transport.close()
        return ""

    # Some wait for the time limit: an answer that has not ended.
    return FuzzTarget("rws transport", "to the driver", valid, feed, lambda: False, 0.0002)


def rws_answers() -> FuzzTarget:
    """Answers to each request of the driver."""
    resources = RwsResources(*_controller(), EmulatedSignals([_SIGNAL]))
    valid = (
        *(msgspec.json.encode({"_embedded": {"_state": resources.read(path)}}) for path in _READ),
        b'{"_embedded": {"status": {"code": "-5", "msg": "not allowed"}}}',
    )
    decoders = (panel_state, mode_selector, rapid_execution, speed_share, latest_error, digital_signal)

    def feed(packet: bytes) -> str:
        error_text(packet)
        refused = ""
        for decode in decoders:
            try:
                decode(packet)
            except AbbLinkError as error:
                refused = error.fault.value
            except SignalUnknown:
                refused = "unknown signal"
            else:
                return ""
        try:
            rws_identity(identity=packet, system=packet)
        except AbbLinkError:
            return refused
        return ""

    return FuzzTarget("rws", "to the driver", valid, feed, lambda: False)


def rws() -> FuzzTarget:
    """Requests without the password, with which nothing is done, and reading ones with it."""
    controller, panel = _controller()
    server = RwsServer(
        RwsResources(controller, panel, EmulatedSignals([_SIGNAL])),
        WireFaults(),
        host="127.0.0.1",
        port=0,
        user="user",
        password="password",
    )
    challenge = server.answer(b"GET /rw/system HTTP/1.1\r\n\r\n", b"").decode("latin-1")
    realm, nonce = (challenge.partition(f'{name}="')[2].partition('"')[0] for name in ("realm", "nonce"))
    valid = (
        *(_authentic("GET", f"{path}?json=1", realm, nonce) for path in (*_PATHS, *_READ[4:])),
        b"POST /rw/panel/ctrlstate?action=setctrlstate HTTP/1.1\r\n\r\nctrl-state=motoroff",
        b"POST /rw/rapid/execution?action=stop HTTP/1.1\r\nAuthorization: Digest username=user\r\n\r\nstopmode=stop",
    )

    def feed(packet: bytes) -> str:
        head, _, body = packet.partition(b"\r\n\r\n")
        try:
            answer = server.answer(head, body)
        except ValueError:
            return "no request"
        code = answer.split(b" ")[1].decode()
        return "" if code == "200" else code

    return FuzzTarget("rws", "to the device", valid, feed, lambda: bool(panel.asked) or controller.travel_rad > 0.0)


def _authentic(method: str, target: str, realm: str, nonce: str) -> bytes:
    def digest(text: str) -> str:
        return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()

    key, request = digest(f"user:{realm}:password"), digest(f"{method}:{target}")
    response = digest(f"{key}:{nonce}:00000001:c:auth:{request}")
    parts = f'username="user", realm="{realm}", nonce="{nonce}", uri="{target}", qop=auth, nc=00000001, cnonce="c"'
    head = f'{method} {target} HTTP/1.1\r\nAuthorization: Digest {parts}, response="{response}"\r\n\r\n'
    return head.encode()


def _controller() -> tuple[EmulatedController, ControllerPanel]:
    controller = EmulatedController(lambda: 0.0, axes=np.zeros(6), stop_s=0.2)
    return controller, ControllerPanel(controller)


ABB: tuple[Callable[[], FuzzTarget], ...] = (rws, rws_answers, egm, egm_codec, rws_transport, egm_socket)
