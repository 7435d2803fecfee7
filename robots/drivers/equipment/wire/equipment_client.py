"""The blocking client of an equipment server, for programs and drivers."""

from __future__ import annotations

import socket
from collections.abc import Generator
from contextlib import contextmanager
from itertools import count
from typing import TypeVar

import msgspec

from engine.errors import RobotError
from robots.drivers.equipment.wire.equipment_messages import (
    ConfigurationText,
    Done,
    EquipmentAnswer,
    EquipmentRefusal,
    EquipmentRequest,
    Greet,
    PinsState,
    ReadConfiguration,
    ReadPins,
    ReadTemplate,
    Restart,
    RollBack,
    SetConfiguration,
    SetPins,
    StopPins,
)
from robots.io.message_socket import MessageSocket, PeerGone
from robots.io.wire.link_error import LinkError

Answer = TypeVar("Answer", bound=EquipmentAnswer)


class EquipmentClient:
    """One connection; each method returns with the answer.

    Raises from every method: RobotError where the server refuses, LinkError where it is gone or silent.
    """

    def __init__(self, connection: socket.socket, address: str) -> None:
        self._socket: MessageSocket[EquipmentAnswer, EquipmentRequest] = MessageSocket(connection, EquipmentAnswer)
        self._address = address
        self._numbers = count(1)

    def greet(self, name: str, *, control: bool) -> str:
        """Say who asks; with `control`, outputs may be set from now on, and silence makes them safe."""
        return self._done(Greet(name=name, control=control))

    def read(self) -> PinsState:
        """Return all pins; a sign of life."""
        return self._answer(ReadPins(), PinsState)

    def set(self, values: dict[str, bool | float]) -> str:
        """Set outputs and return when they are read back."""
        return self._done(SetPins(values=values))

    def stop(self) -> str:
        """STOP: make safe what the document says."""
        return self._done(StopPins())

    def configuration(self) -> ConfigurationText:
        """Return the configuration in effect."""
        return self._answer(ReadConfiguration(), ConfigurationText)

    def template(self) -> ConfigurationText:
        """Return a commented example for the hardware."""
        return self._answer(ReadTemplate(), ConfigurationText)

    def configure(self, text: str, *, base: str) -> str:
        """Replace the configuration with the digest `base`."""
        return self._done(SetConfiguration(text=text, base=base))

    def roll_back(self, *, base: str) -> str:
        """Take back the last change of the configuration with the digest `base`."""
        return self._done(RollBack(base=base))

    def restart(self) -> str:
        """Have the file read anew."""
        return self._done(Restart())

    def _done(self, request: EquipmentRequest) -> str:
        return self._answer(request, Done).message

    def _answer(self, request: EquipmentRequest, kind: type[Answer]) -> Answer:
        number = next(self._numbers)
        try:
            self._socket.send(request, number=number)
            answered, answer = self._socket.wait()
        except TimeoutError as error:
            raise LinkError("the equipment server does not answer in time") from error
        except (PeerGone, OSError) as error:
            raise LinkError("the equipment server has closed the connection") from error
        except (msgspec.MsgspecError, RobotError) as error:
            raise LinkError(f"what answers is no equipment server: {error}") from error
        if isinstance(answer, EquipmentRefusal):
            raise RobotError(answer.reason, where=self._address, hint=answer.hint or None)
        if answered != number or not isinstance(answer, kind):
            raise LinkError(f"the equipment server answered request {number} with {type(answer).__name__} {answered}")
        return answer


@contextmanager
def connected(
    host: str, port: int, *, name: str, control: bool = False, timeout_s: float = 2.0
) -> Generator[EquipmentClient]:
    """Connect to a server, greet it, and disconnect at the end.

    Raises:
        RobotError: it refuses, as another client controls.
        LinkError: nothing listens there, or it is no equipment server.
    """
    try:
        connection = socket.create_connection((host, port), timeout_s)
    except OSError as error:
        raise LinkError(f"cannot connect: {error}") from error
    with connection:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        client = EquipmentClient(connection, f"{host}:{port}")
        client.greet(name, control=control)
        yield client


@contextmanager
def connected_to_configure(host: str, port: int, *, name: str, timeout_s: float) -> Generator[EquipmentClient]:
    """Connect for the commands of a person, without control of the outputs.

    Raises:
        RobotError: the server refuses, does not answer, or nothing listens there.
    """
    try:
        with connected(host, port, name=name, timeout_s=timeout_s) as client:
            yield client
    except LinkError as error:
        raise RobotError(
            str(error), where=f"{host}:{port}", hint="see whether `flexcell equipment serve` runs there"
        ) from error
