"""The connections to an equipment server: one that reads, and controls once it is told to, and one for STOP."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import Literal

from engine.errors import RobotError
from robots.drivers.equipment.wire.equipment_client import EquipmentClient, connected
from robots.drivers.equipment.wire.equipment_messages import PinsState
from robots.io.wire.link_error import LinkError

_STOP_S = 1.0


@dataclass(frozen=True, kw_only=True)
class EquipmentReading:
    """All pins, and whether this client controls; `uncontrolled` says why it does not any more."""

    pins: PinsState
    controls: bool
    uncontrolled: str = ""


@dataclass(kw_only=True, eq=False)
class EquipmentCommand:
    """Takes control, lets it go, or sets outputs. One that is revoked before it is sent is refused.

    `refusal` is set, by the thread of the link, before the command counts as written.
    """

    action: Literal["control", "let_go", "set"]
    values: dict[str, bool | float] = field(default_factory=dict[str, bool | float])
    revoked: str = ""
    refusal: RobotError | None = None

    def require_done(self) -> None:
        """Raise RobotError if it was refused."""
        if self.refusal is not None:
            raise self.refusal


class EquipmentTransport:
    """Implements `DeviceTransport`: connects without control, which is asked for by a command and never by itself.

    Args:
        host: Where the server runs.
        port: Its port.
        client: How this client calls itself.
        timeout_s: Time limit of each request.
    """

    def __init__(self, *, host: str, port: int, client: str, timeout_s: float) -> None:
        self._host = host
        self._port = port
        self._client_name = client
        self._timeout_s = timeout_s
        self._stack = ExitStack()
        self._client: EquipmentClient | None = None
        self._controls = False
        self._uncontrolled = ""

    @property
    def address(self) -> str:
        """Where the server is."""
        return f"{self._host}:{self._port}"

    @property
    def remedy(self) -> str:
        """What to check when it does not answer."""
        return "see whether `flexcell equipment serve` runs there, and the network to it"

    def open(self) -> None:
        """Connect, without control."""
        try:
            self._client = self._stack.enter_context(
                connected(self._host, self._port, name=self._client_name, timeout_s=self._timeout_s)
            )
        except RobotError as error:
            raise LinkError(error.message) from error

    def close(self) -> None:
        """Disconnect, which ends control: the server makes outputs safe."""
        self._client, self._controls = None, False
        self._stack.close()

    def read(self) -> EquipmentReading:
        """Return all pins; after the server has ended control, from a new connection without it."""
        try:
            pins = self._opened().read()
        except RobotError as error:
            self._uncontrolled = error.message
            self.close()
            self.open()
            try:
                pins = self._opened().read()
            except RobotError as again:
                raise LinkError(again.message) from again
        return EquipmentReading(pins=pins, controls=self._controls, uncontrolled=self._uncontrolled)

    def write(self, command: EquipmentCommand) -> None:
        """Execute a command; a refusal is noted in it."""
        if command.revoked:
            command.refusal = RobotError(command.revoked, where=self.address)
            return
        try:
            match command.action:
                case "control":
                    self._opened().greet(self._client_name, control=True)
                    self._controls, self._uncontrolled = True, ""
                case "let_go":
                    self.close()
                    self.open()
                case "set":
                    self._opened().set(command.values)
        except RobotError as error:
            command.refusal = error

    def send_stop(self) -> None:
        """Send STOP on a connection of its own, which waits for no other request.

        Raises:
            RobotError: the server refuses.
            LinkError: it is not reached.
        """
        limit_s = min(_STOP_S, 2.0 * self._timeout_s)
        with connected(self._host, self._port, name=f"STOP of {self._client_name}", timeout_s=limit_s) as client:
            client.stop()

    def _opened(self) -> EquipmentClient:
        if self._client is None:
            raise LinkError("not connected")
        return self._client
