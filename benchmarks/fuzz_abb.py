"""Robot Web Services and Externally Guided Motion: the emulated controller is fed, and the codecs of its driver."""

from __future__ import annotations

import hashlib
from collections.abc import Callable

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
from robots.drivers.abb.emulation.controller_panel import ControllerPanel
from robots.drivers.abb.emulation.egm_source import EgmSource
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.emulation.rws_resources import RwsResources
from robots.drivers.abb.emulation.rws_server import RwsServer
from robots.drivers.abb.rws.rws_state import (
    error_text,
    latest_error,
    mode_selector,
    panel_state,
    rapid_execution,
    rws_identity,
    speed_share,
)
from robots.drivers.emulation.wire_faults import WireFaults

_ANGLES = (1.0, -2.0, 0.0, 0.5, 0.0, 180.0)
_PATHS = ("/rw/panel/ctrlstate", "/rw/rapid/execution", "/rw/elog/0", "/ctrl/identity", "/rw/nothing")


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
    source = EgmSource(controller, panel, WireFaults(), client=None, stop_s=0.2, comm_timeout_s=0.2)
    valid = tuple(encode_set_point(EgmSetPoint(number=n, time_ms=4 * n, planned_deg=_ANGLES)) for n in (1, 2**31))

    def feed(packet: bytes) -> str:
        source.datagram_received(packet, ("127.0.0.1", 6510))
        return "ignored"

    return FuzzTarget("egm", "to the device", valid, feed, lambda: source.heard > 0 or controller.travel_rad > 0.0)


def rws_answers() -> FuzzTarget:
    """Answers to each request of the driver."""
    resources = RwsResources(*_controller())
    valid = (
        *(msgspec.json.encode({"_embedded": {"_state": resources.read(path)}}) for path in _PATHS[:4]),
        b'{"_embedded": {"status": {"code": "-5", "msg": "not allowed"}}}',
    )
    decoders = (panel_state, mode_selector, rapid_execution, speed_share, latest_error)

    def feed(packet: bytes) -> str:
        error_text(packet)
        refused = ""
        for decode in decoders:
            try:
                decode(packet)
            except AbbLinkError as error:
                refused = error.fault.value
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
        RwsResources(controller, panel), WireFaults(), host="127.0.0.1", port=0, user="user", password="password"
    )
    challenge = server.answer(b"GET /rw/system HTTP/1.1\r\n\r\n", b"").decode("latin-1")
    realm, nonce = (challenge.partition(f'{name}="')[2].partition('"')[0] for name in ("realm", "nonce"))
    valid = (
        *(_authentic("GET", f"{path}?json=1", realm, nonce) for path in _PATHS),
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


ABB: tuple[Callable[[], FuzzTarget], ...] = (rws, rws_answers, egm, egm_codec)
