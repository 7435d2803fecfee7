"""Reads the state of the controller over Robot Web Services, and does there what a person has asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import Enum

from robots.drivers.abb.abb_faults import REMEDIES, AbbFault, AbbLinkError
from robots.drivers.abb.rws.rws_client import RwsClient, RwsRefused
from robots.drivers.abb.rws.rws_state import (
    ControllerEvent,
    RwsIdentity,
    RwsState,
    SignalUnknown,
    digital_signal,
    latest_error,
    mode_selector,
    panel_state,
    rapid_execution,
    rws_identity,
    speed_share,
)

PANEL, MODE, EXECUTION, SPEED = (
    "/rw/panel/ctrlstate",
    "/rw/panel/opmode",
    "/rw/rapid/execution",
    "/rw/panel/speedratio",
)
SIGNALS = "/rw/iosystem/signals"
IDENTITY, SYSTEM, EVENT_LOG = "/ctrl/identity", "/rw/system", "/rw/elog/0"
_START = {
    "regain": "continue",
    "execmode": "continue",
    "cycle": "asis",
    "condition": "none",
    "stopatbp": "disabled",
    "alltaskbytsp": "true",
}


class RwsCommand(Enum):
    """What a person may have done at the controller; `READ_NOW` does nothing but end the wait for the next reading."""

    READ_NOW = "read the state"
    MOTORS_ON = "switch the motors on"
    PROGRAM_TO_MAIN = "move the program pointer to main"
    START_PROGRAM = "start the program"


class RwsTransport:
    """Implements `DeviceTransport` over HTTP.

    Args:
        address: Host and port, for messages.
        new_client: Begins a session.
        signals: Names of the signals that are the inputs of the arm.
    """

    def __init__(self, address: str, new_client: Callable[[], RwsClient], *, signals: Sequence[str] = ()) -> None:
        self._address = address
        self._signals = tuple(signals)
        self._new_client = new_client
        self._client: RwsClient | None = None
        self._identity: RwsIdentity | None = None
        self._event: ControllerEvent | None = None
        self._logged: tuple[object, ...] = ()
        self._fault = AbbFault.LINK_CUT
        self.refusals: dict[RwsCommand, str] = {}
        """Why a command was refused the last time; assigned by the thread before the command is acknowledged."""

    @property
    def address(self) -> str:
        """Host and port."""
        return self._address

    @property
    def remedy(self) -> str:
        """What to check when nothing comes."""
        if self._fault is AbbFault.REFUSED:
            return "check `user` and `password` of `rws`, and how many clients the controller has"
        return REMEDIES[self._fault] if self._fault is not AbbFault.GARBAGE else "check `port` of `rws`"

    def open(self) -> None:
        """Begin a session."""
        self._client = self._new_client()
        self._identity, self._logged = None, ()

    def close(self) -> None:
        """End the session."""
        client, self._client = self._client, None
        if client is not None:
            client.close()

    def read(self) -> RwsState:
        """Ask for each resource; for the event log only where the state has changed."""
        try:
            return self._read()
        except AbbLinkError as error:
            self._fault = error.fault
            raise

    def _read(self) -> RwsState:
        client = self._opened()
        # What follows from a stop is read before what causes it: where it has been seen, its cause is seen too.
        execution = rapid_execution(client.get(EXECUTION))
        panel, mode = panel_state(client.get(PANEL)), mode_selector(client.get(MODE))
        if self._identity is None:
            self._identity = rws_identity(identity=client.get(IDENTITY), system=client.get(SYSTEM))
        logged = (panel, mode, execution)
        if logged != self._logged:
            self._event = latest_error(client.get(EVENT_LOG, lang="en"))
            self._logged = logged
        inputs, inputs_problem = self._inputs(client)
        return RwsState(
            panel=panel,
            mode=mode,
            execution=execution,
            speed_share=speed_share(client.get(SPEED)),
            latest_error=self._event,
            identity=self._identity,
            inputs=inputs,
            inputs_problem=inputs_problem,
        )

    def _inputs(self, client: RwsClient) -> tuple[tuple[bool, ...], str]:
        """Return the values of all signals, or why one is not known; a signal that is missing loses no connection."""
        values: list[bool] = []
        for name in self._signals:
            try:
                values.append(digital_signal(client.look_up(f"{SIGNALS}/{name}")))
            except (RwsRefused, SignalUnknown) as error:
                return (), f"the signal {name} of the controller is not known: {error}"
        return tuple(values), ""

    def write(self, command: RwsCommand) -> None:
        """Do what a person has asked for; a refusal is kept in `refusals`."""
        client = self._opened()
        self.refusals.pop(command, None)
        try:
            match command:
                case RwsCommand.READ_NOW:
                    self._logged = ()
                case RwsCommand.MOTORS_ON:
                    client.post(PANEL, "setctrlstate", {"ctrl-state": "motoron"})
                case RwsCommand.PROGRAM_TO_MAIN:
                    client.post(EXECUTION, "resetpp", {})
                case RwsCommand.START_PROGRAM:
                    client.post(EXECUTION, "start", _START)
        except RwsRefused as error:
            self.refusals[command] = str(error)

    def _opened(self) -> RwsClient:
        if self._client is None:
            raise AbbLinkError(AbbFault.LINK_CUT, "RWS is not connected")
        return self._client
