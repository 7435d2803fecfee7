"""Externally Guided Motion of the emulated controller, with the program FlexcellEgm in its motion task.

It sends a measurement 250 times a second and follows the answers. Without one for `comm_timeout_s` guided motion ends
where the last one led, and begins again after a pause. Measurements are sent while the program is stopped too. What is
measured are the axes of its plant; the set points that it sends to them are what it plans.
"""

from __future__ import annotations

import asyncio
import math
import socket
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from robots.drivers.abb.abb_faults import AbbLinkError
from robots.drivers.abb.egm.egm_messages import (
    EgmMeasurement,
    MciState,
    MotorState,
    RapidState,
    decode_set_point,
    encode_measurement,
)
from robots.drivers.abb.egm.egm_options import PERIOD_S
from robots.drivers.abb.emulation.controller_panel import ControllerPanel
from robots.drivers.abb.emulation.emulated_controller import AXES, EmulatedController
from robots.drivers.emulation.plant import PlantClock
from robots.drivers.emulation.wire_faults import WireFaults, spoil
from robots.port import Array

_FASTEST_RAD_S = np.array([3.05, 3.05, 3.05, 4.36, 4.36, 6.28])
_FURTHEST_RAD = 7.0
_PAUSE_S = 0.05
_STILL_RAD_S, _STILL_S = 1e-6, 0.05
_MOST_LATE_TICKS = 25
_OUT_OF_RANGE = 50027
_MOST_BYTES = 4096


@dataclass
class EgmFaults:
    """What goes wrong with datagrams of guided motion alone.

    `wire`: as of all ports. `deaf`: answers get lost. `repeats`: each measurement is sent twice, the second time late.
    """

    wire: WireFaults
    deaf: bool = False
    repeats: bool = False


class EgmSource:
    """One client at a time: the one that the controller is configured for. Each cycle takes all that has come.

    Args:
        controller: Its axes are guided.
        panel: Says whether the program runs.
        faults: Of the wire of the whole controller.
        client: Where measurements are sent; None for nowhere.
        clock: The time of the controller and of its axes.
        stop_s: Time to brake from the greatest speed.
        comm_timeout_s: As in the program.
    """

    def __init__(
        self,
        controller: EmulatedController,
        panel: ControllerPanel,
        faults: WireFaults,
        *,
        client: tuple[str, int] | None,
        clock: PlantClock,
        stop_s: float,
        comm_timeout_s: float,
    ) -> None:
        self._controller = controller
        self._panel = panel
        self._faults = faults
        self.own_faults = EgmFaults(WireFaults())
        self._client = client
        self._clock = clock
        self._stop_s = stop_s
        self._comm_timeout_s = comm_timeout_s
        self._socket: socket.socket | None = None
        self._ticking: asyncio.Task[None] | None = None
        self._number = 0
        self._time_ms = 0
        self._reference: Array | None = None
        self._velocity: Array = np.zeros(AXES)
        self._moved_s = 0.0
        self._begun_s: float | None = None
        self._heard_s = self._ended_s = -math.inf
        self._previous = b""
        self.heard = 0
        """Number of set points that were followed."""
        self.last_heard_s = 0.0
        """When the last one came, on the controller's clock."""
        self.comm_timeouts = 0
        """How often guided motion that was followed ended without an answer."""
        self.rested_s = 0.0

    @property
    def state(self) -> dict[str, object]:
        """What the side channel says of it."""
        return {
            "heard": self.heard,
            "last_heard_s": self.last_heard_s,
            "comm_timeouts": self.comm_timeouts,
            "mci": self._mci.name,
            "followed": self._reference is not None,
            "rested_s": self.rested_s,
        }

    async def open(self, host: str) -> None:
        """Begin to send, where there is a client."""
        if self._client is None:
            return
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.bind((host, 0))
        self._ticking = asyncio.create_task(self._tick_forever(), name="guided motion")

    def close(self) -> None:
        """Stop sending."""
        if self._ticking is not None:
            self._ticking.cancel()
        opened, self._socket = self._socket, None
        if opened is not None:
            opened.close()

    def _hear(self) -> None:
        """Take all set points that have come: those that a late machine left waiting would be followed late."""
        with suppress(BlockingIOError):
            while self._socket is not None:
                # An answer to a port that was closed is an error of the next call: the controller sends on.
                with suppress(ConnectionRefusedError):
                    self.take(self._socket.recv(_MOST_BYTES + 1))

    def take(self, data: bytes) -> None:
        """Take a set point; anything else is ignored."""
        if self._is_cut or self.own_faults.deaf or len(data) > _MOST_BYTES:
            return
        try:
            set_point = decode_set_point(data)
        except AbbLinkError:
            return
        self._heard_s = self._controller.now_s()
        if self._mci is not MciState.RUNNING:
            return
        reference = np.radians(set_point.planned_deg)
        if np.abs(reference).max() > _FURTHEST_RAD:
            self._controller.error_code = _OUT_OF_RANGE
            self._panel.stop_program()
            self._panel.note_changes()
            return
        self._reference, self.last_heard_s = reference, self._heard_s
        self.heard += 1

    @property
    def _is_cut(self) -> bool:
        return self._faults.cut or self.own_faults.wire.cut

    @property
    def _mci(self) -> MciState:
        runs = self._panel.execution == "running"
        return MciState.RUNNING if runs and self._begun_s is not None else MciState.STOPPED

    async def _tick_forever(self) -> None:
        clock = self._clock
        due_s = clock.now_s()
        while True:
            due_s += PERIOD_S
            # A machine that is late makes up for little of it: the arm must not jump.
            late_s = clock.now_s() - _MOST_LATE_TICKS * PERIOD_S - due_s
            if late_s > 0.0:
                due_s += late_s
                self._time_ms += round(late_s * 1e3)
            await clock.sleep_until(due_s)
            self._tick()

    def _tick(self) -> None:
        self._hear()
        self._watch()
        self._move()
        self._controller.advance()
        self._number, self._time_ms = self._number + 1, self._time_ms + round(PERIOD_S * 1e3)
        self._send()

    def _watch(self) -> None:
        """Begin and end guided motion as the program does."""
        now_s = self._controller.now_s()
        if self._panel.execution != "running":
            self._begun_s = self._reference = None
            return
        if self._begun_s is None:
            if now_s - self._ended_s > _PAUSE_S:
                self._begun_s, self._reference = now_s, None
            return
        if now_s - max(self._begun_s, self._heard_s) > self._comm_timeout_s:
            self.comm_timeouts += self._reference is not None
            self._begun_s = self._reference = None
            self._ended_s = now_s

    def _move(self) -> None:
        """Go to the reference within the speeds of the axes, or brake."""
        controller, reference = self._controller, self._reference
        if controller.in_motion and not controller.guided:
            return  # a downloaded path moves it
        if reference is not None:
            step = np.clip(reference - controller.axes, -_FASTEST_RAD_S * PERIOD_S, _FASTEST_RAD_S * PERIOD_S)
            self._velocity = step / PERIOD_S
        else:
            most = _FASTEST_RAD_S / self._stop_s * PERIOD_S
            self._velocity = self._velocity - np.clip(self._velocity, -most, most)
        now_s = controller.now_s()
        if np.abs(self._velocity).max() > _STILL_RAD_S:
            self._moved_s, controller.guided = now_s, True
        elif controller.guided and now_s - self._moved_s > _STILL_S:
            # A set point that is late by some periods is no rest.
            self.rested_s, controller.guided = self._moved_s, False
        step = self._velocity * PERIOD_S
        controller.axes = controller.axes + step
        controller.travel_rad += float(np.abs(step).max())

    def _send(self) -> None:
        own, shared = self.own_faults, self._faults
        if self._socket is None or self._client is None or self._is_cut or shared.frozen or own.wire.frozen:
            return
        packet = encode_measurement(self._measurement())
        sent = spoil(packet) if shared.garbage or own.wire.garbage else packet
        late_s = max(shared.slow_s, own.wire.slow_s)
        asyncio.get_running_loop().call_later(late_s, self._send_late, sent)
        if own.repeats and self._previous:
            self._send_late(self._previous)
        self._previous = packet

    def _send_late(self, packet: bytes) -> None:
        if self._socket is not None and self._client is not None:
            # What cannot be sent, or to where nobody listens, is lost.
            with suppress(BlockingIOError, ConnectionRefusedError):
                self._socket.sendto(packet, self._client)

    def _measurement(self) -> EgmMeasurement:
        measured = self._controller.plant.measured()[0]
        held = self._reference if self._reference is not None else self._controller.axes
        motors = MotorState.ON if self._panel.state == "motoron" else MotorState.OFF
        rapid = RapidState.RUNNING if self._panel.execution == "running" else RapidState.STOPPED
        return EgmMeasurement(
            number=self._number,
            time_ms=self._time_ms,
            measured_deg=tuple(np.degrees(measured).tolist()),
            planned_deg=tuple(np.degrees(held).tolist()),
            motors=motors,
            mci=self._mci,
            rapid=rapid,
        )
