"""Follows the state of a controller over Robot Web Services, and recovers it when a person asks for that.

Its loss stops no motion: simple_message tells of every stop too, and sooner, only less precisely.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable

from engine.errors import RobotError
from robots.drivers.abb.abb_faults import REMEDIES, AbbFault
from robots.drivers.abb.rws.rws_client import RwsClient
from robots.drivers.abb.rws.rws_faults import RECOVERABLE, rws_fault
from robots.drivers.abb.rws.rws_options import RwsOptions
from robots.drivers.abb.rws.rws_state import RwsState
from robots.drivers.abb.rws.rws_transport import RwsCommand, RwsTransport
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming
from robots.io.wire.wire_tap import NO_TAP, WireTap

_PERIOD_S = 0.5
"""Four requests each, and one for each input: the controller serves about twenty a second to all of its clients."""
_RECOVERY_S = 10.0
_log = logging.getLogger("flexcell.devices")

Fault = tuple[AbbFault, str]


class RwsMonitor:
    """Implements `LinkListener`.

    Args:
        name: The arm, for messages.
        host: Of the driver.
        options: Of the service.
        password: Of the user.
        tap: Notes what is said, without credentials.
    """

    def __init__(self, name: str, host: str, options: RwsOptions, *, password: str, tap: WireTap = NO_TAP) -> None:
        self._name = name
        self._options = options
        where = options.host or host
        self._transport = RwsTransport(
            f"{where}:{options.port}",
            lambda: RwsClient(
                where, options.port, user=options.user, password=password, timeout_s=options.timeout_s, tap=tap
            ),
            signals=options.inputs,
        )
        self._changed: Callable[[], None] = lambda: None
        self._link: FreshLink[RwsState, RwsCommand] | None = None
        self._state: RwsState | None = None
        self._asked_s = 0.0
        self._since_event = 0
        self._lost = ""
        self._next: asyncio.Future[None] | None = None

    @property
    def lost_reason(self) -> str:
        """Why the service is not read; empty while it is."""
        return self._lost

    @property
    def state(self) -> RwsState | None:
        """The last state; None before the first one, and while the service is lost."""
        return None if self._lost else self._state

    @property
    def read_s(self) -> float:
        """When the last state was asked for, on the monotonic clock."""
        return self._asked_s

    @property
    def fault(self) -> Fault | None:
        """Why the controller does not move; None if it can, and while the service is lost."""
        state = self.state
        return rws_fault(state, since_event=self._since_event) if state is not None else None

    @property
    def speed_share(self) -> float | None:
        """The speed of the panel, 0 to 1; the last one after a loss, None before the first."""
        return self._state.speed_share if self._state is not None else None

    @property
    def permitted_share(self) -> float:
        """The speed of the panel, 0 to 1, if it is known at present; else 1."""
        state = self.state
        return 1.0 if state is None else state.speed_share

    @property
    def firmware(self) -> str:
        """RobotWare, system, name and serial number of the controller; empty before the first reading."""
        if self._state is None:
            return ""
        its = self._state.identity
        return f"RobotWare {its.robotware}, system {its.system}, controller {its.name}, serial {its.serial}"

    @property
    def input_count(self) -> int:
        """How many signals are inputs of the arm."""
        return len(self._options.inputs)

    @property
    def input_values(self) -> tuple[bool, ...]:
        """The signals that are the inputs of the arm; empty with an `inputs_problem`."""
        return self._state.inputs if self._state is not None and not self.inputs_problem else ()

    @property
    def inputs_problem(self) -> str:
        """Why the inputs are not known at present; empty if they are."""
        if self._lost or self._state is None:
            return f"RWS is lost: {self._lost}" if self._lost else "RWS was not read yet"
        age_s = time.monotonic() - self._asked_s
        if age_s > self._options.stale_s:
            return f"RWS was not read for {age_s:.1f} s"
        return self._state.inputs_problem

    def when_changed(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, for each reading, and when the service is lost."""
        self._changed = callback

    async def open(self) -> None:
        """Connect and return with the first state; raises RobotError."""
        timing = LinkTiming(period_s=_PERIOD_S, stale_s=self._options.stale_s)
        link = FreshLink[RwsState, RwsCommand](self._transport, self, timing)
        try:
            await link.start()
        except RobotError as error:
            raise RobotError(error.statement, where=self._name, hint=error.hint) from error
        self._link = link

    async def close(self) -> None:
        """Disconnect."""
        link, self._link = self._link, None
        if link is not None:
            await link.close()

    def read_now(self) -> None:
        """Ask for the state at once: something else says that it has changed."""
        if self._link is not None:
            self._link.submit(RwsCommand.READ_NOW).add_done_callback(lambda done: done.exception())

    async def require_recoverable(self) -> None:
        """Return where the controller can move, or `recover` can help.

        Raises:
            RobotError: the service is lost, or the cause needs a person at the controller.
        """
        await self._read_fresh()
        fault = self.fault
        if fault is not None and fault[0] not in RECOVERABLE:
            raise RobotError(
                f"the arm cannot be enabled: {fault[0].value}: {fault[1]}", where=self._name, hint=REMEDIES[fault[0]]
            )

    async def recover(self) -> None:
        """Switch the motors on, move the program pointer to main and start the program, as far as each is needed.

        Raises:
            RobotError: the service is lost, the cause needs a person at the controller, or it refuses.
        """
        await self.require_recoverable()
        state = await self._read_fresh()
        if state.panel != "motoron":
            await self._do(RwsCommand.MOTORS_ON)
            state = await self._until(lambda now: now.panel == "motoron")
        if state.execution != "running":
            await self._do(RwsCommand.PROGRAM_TO_MAIN)
            await self._do(RwsCommand.START_PROGRAM)
        await self._until(lambda now: rws_fault(now, since_event=0) is None)

    def read(self, reading: FreshReading[RwsState]) -> None:
        """Take a state."""
        self._state, self._asked_s = reading.value, reading.asked_s
        event = reading.value.latest_error
        if event is not None and rws_fault(reading.value, since_event=0) is None:
            self._since_event = event.number
        self._wake()
        self._changed()

    def lost(self, reason: str) -> None:
        """Note that the service is lost; the arm may go on."""
        self._lost = reason
        _log.warning("%s: RWS is lost, and motions go on: %s", self._name, reason)
        self._wake()
        self._changed()

    def found(self) -> None:
        """Note that the service is back."""
        self._lost = ""
        _log.warning("%s: RWS reads again", self._name)

    def stopped_by_silence(self, silent_s: float) -> None:
        """Do nothing: this link commands no motion."""

    async def _do(self, command: RwsCommand) -> None:
        link = self._opened()
        _log.warning("%s: %s, over RWS", self._name, command.value)
        await link.submit(command)
        refusal = self._transport.refusals.get(command, "")
        if refusal:
            raise RobotError(
                f"the controller does not {command.value}: {refusal}",
                where=self._name,
                hint="read the event log on the FlexPendant; the user of `rws` needs the grant",
            )

    async def _read_fresh(self) -> RwsState:
        """Return a state that was asked for from now on."""
        link = self._opened()
        asked_s = await link.submit(RwsCommand.READ_NOW)
        while self._asked_s < asked_s:
            await self._next_reading()
        state = self.state
        if state is None:
            raise self._lost_error()
        return state

    async def _until(self, reached: Callable[[RwsState], bool]) -> RwsState:
        """Read until the controller is as expected; raises RobotError where it is not in time."""
        try:
            async with asyncio.timeout(_RECOVERY_S):
                while True:
                    state = await self._read_fresh()
                    if reached(state):
                        return state
                    await self._next_reading()
        except TimeoutError:
            fault = self.fault
            reason = f"{fault[0].value}: {fault[1]}" if fault is not None else "it does not say why"
            raise RobotError(f"the controller does not recover: {reason}", where=self._name) from None

    def _wake(self) -> None:
        waiting, self._next = self._next, None
        if waiting is not None and not waiting.done():
            waiting.set_result(None)

    async def _next_reading(self) -> None:
        if self._lost:
            raise self._lost_error()
        if self._next is None:
            self._next = asyncio.get_running_loop().create_future()
        await asyncio.shield(self._next)

    def _opened(self) -> FreshLink[RwsState, RwsCommand]:
        if self._link is None or self._lost:
            raise self._lost_error()
        return self._link

    def _lost_error(self) -> RobotError:
        reason = self._lost or "not connected"
        return RobotError(f"RWS is lost: {reason}", where=self._name, hint=self._transport.remedy)
