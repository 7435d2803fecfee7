"""The equipment server: one client controls, others read; configurations are read, replaced and taken back."""

from __future__ import annotations

import asyncio
import time
from typing import Self

from engine.document.equipment import Equipment, read_equipment
from engine.errors import DocumentError, FlexcellError, RobotError
from robots.drivers.equipment.configuration_file import ConfigurationFile, text_digest
from robots.drivers.equipment.configuration_template import configuration_template
from robots.drivers.equipment.equipment_session import EquipmentSession
from robots.drivers.equipment.guarded_pins import GuardedPins
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

_WATCH_S = 0.02


class EquipmentServer:
    """Serves one configuration file; `async with` it.

    Args:
        configuration: The file.
        host: Address to listen on.
        port: 0 for a free one; `port` is the one in use afterwards.
    """

    def __init__(self, configuration: ConfigurationFile, *, host: str, port: int) -> None:
        self._configuration = configuration
        self._host = host
        self.port = port
        self._sequence = 0
        self._controller: EquipmentSession | None = None
        self._sessions: set[EquipmentSession] = set()
        self._changing = asyncio.Lock()

    async def __aenter__(self) -> Self:
        """Make outputs safe and listen.

        Raises:
            DocumentError: the file is not valid.
            RobotError: the pins are not reached, or the address is taken.
        """
        self._text = self._configuration.text()
        self._pins = self._new_pins(read_equipment(self._text, file=self._configuration.file))
        await self._pins.open()
        try:
            self._server = await asyncio.start_server(self._serve, self._host, self.port)
        except OSError as error:
            await self._pins.close()
            hint = "choose another --port, or end the program that has it"
            raise RobotError(f"cannot listen at {self._host}:{self.port}: {error.strerror}", hint=hint) from error
        self.port = int(self._server.sockets[0].getsockname()[1])
        self._watching = asyncio.create_task(self._watch())
        return self

    async def __aexit__(self, *_: object) -> None:
        """Make outputs safe, drop all clients, let the pins go."""
        self._watching.cancel()
        self._server.close()
        self._release("the equipment server ends")
        for session in tuple(self._sessions):
            session.drop()
        await asyncio.gather(
            self._watching, *(session.ended.wait() for session in self._sessions), return_exceptions=True
        )
        await self._pins.close()

    @property
    def equipment(self) -> str:
        """Name of what is served."""
        return self._pins.document.equipment

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        session = EquipmentSession(reader, writer, self._answer)
        self._sessions.add(session)
        try:
            await session.serve()
        finally:
            self._sessions.discard(session)
            if session is self._controller:
                self._release(f"{session} is gone")

    async def _watch(self) -> None:
        """Make outputs safe when the client that controls is silent."""
        while True:
            await asyncio.sleep(_WATCH_S)
            controller = self._controller
            if controller is not None:
                silent_s = time.monotonic() - controller.heard_s
                if silent_s > self._pins.document.silence_s:
                    self._release(f"{controller} was silent for {silent_s:.2f} s")

    def _release(self, reason: str) -> None:
        """End the control of a client: outputs go to their safe values and stay there until one sets them."""
        controller, self._controller = self._controller, None
        if controller is not None:
            controller.lost_control = f"control was lost: {reason}; outputs are at their safe values"
            self._pins.begin_safe()

    async def _answer(self, session: EquipmentSession, request: EquipmentRequest) -> EquipmentAnswer:
        try:
            return await self._execute(session, request)
        except FlexcellError as error:
            where = f"{error.where}: " if isinstance(error, DocumentError) and error.where else ""
            return EquipmentRefusal(reason=f"{where}{error.message}", hint=error.hint or "")

    async def _execute(self, session: EquipmentSession, request: EquipmentRequest) -> EquipmentAnswer:
        match request:
            case Greet():
                return self._greet(session, request)
            case ReadPins():
                if session.lost_control:
                    raise RobotError(session.lost_control, hint="connect again; set again what is needed")
                return self._state()
            case SetPins(values=values):
                self._require_control(session)
                await self._pins.set(values)
                self._require_control(session)
                return Done(message="set and read back")
            case StopPins():
                await self._pins.stop()
                return Done(message="outputs are as STOP has them")
            case ReadConfiguration():
                return ConfigurationText(
                    text=self._text, digest=text_digest(self._text), kept=self._configuration.kept()
                )
            case ReadTemplate():
                text = configuration_template(self._pins.document.backend)
                return ConfigurationText(text=text, digest=text_digest(text))
            case SetConfiguration(text=text, base=base):
                return await self._change(session, text, base=base, take_back=False)
            case RollBack(base=base):
                return await self._change(session, self._configuration.previous(), base=base, take_back=True)
            case Restart():
                return await self._restart(session)

    def _greet(self, session: EquipmentSession, request: Greet) -> Done:
        session.name = request.name
        if not request.control:
            return Done(message=self.equipment)
        if self._controller is not None and self._controller is not session:
            hint = "end that client first; this one may read without control"
            raise RobotError(f"{self.equipment} is controlled by {self._controller}", hint=hint)
        if self._pins.problem:
            raise RobotError(self._pins.problem)
        session.lost_control = ""
        self._controller = session
        self._pins.watch()
        return Done(message=self.equipment)

    def _require_control(self, session: EquipmentSession) -> None:
        if session is not self._controller:
            reason = session.lost_control or "this client does not control the equipment"
            raise RobotError(reason, hint="connect again with control; set again what is needed")

    def _state(self) -> PinsState:
        self._sequence += 1
        pins = self._pins
        return PinsState(
            equipment=self.equipment,
            sequence=self._sequence,
            values=dict(pins.values),
            kinds={name: str(pin.__struct_config__.tag) for name, pin in pins.document.pins.items()},
            age_s=pins.age_s,
            controller=str(self._controller or ""),
            problem=pins.problem,
        )

    async def _change(self, session: EquipmentSession, text: str, *, base: str, take_back: bool) -> Done:
        async with self._changing:
            self._require_free(session)
            self._configuration.require_base(base)
            equipment = read_equipment(text, file=self._configuration.file)
            if take_back:
                self._configuration.take_back(base=base)
            else:
                self._configuration.replace(text, base=base)
            try:
                await self._serve_pins(equipment, text)
            except RobotError as error:
                await self._return_to(self._text)
                raise RobotError(f"the new configuration was taken back: {error.statement}", hint=error.hint) from error
            return Done(message=f"{self.equipment} is served by the new configuration")

    async def _return_to(self, text: str) -> None:
        """Serve the configuration of before, after the new one could not be."""
        self._configuration.replace(text, base=self._configuration.digest())
        await self._serve_pins(read_equipment(text, file=self._configuration.file), text)

    async def _restart(self, session: EquipmentSession) -> Done:
        async with self._changing:
            self._require_free(session)
            text = self._configuration.text()
            await self._serve_pins(read_equipment(text, file=self._configuration.file), text)
            return Done(message=f"{self.equipment} was read anew")

    def _require_free(self, session: EquipmentSession) -> None:
        if self._controller is not None and self._controller is not session:
            hint = "end that client first: a new configuration takes all outputs to their safe values"
            raise RobotError(f"{self.equipment} is controlled by {self._controller}", hint=hint)

    async def _serve_pins(self, equipment: Equipment, text: str) -> None:
        """Make outputs safe, and serve a document instead of the one of before; nobody controls then."""
        self._release("the configuration was read anew")
        await self._pins.close()
        pins = self._new_pins(equipment)
        self._pins = pins
        await pins.open()
        self._text = text

    def _new_pins(self, equipment: Equipment) -> GuardedPins:
        return GuardedPins(equipment.document, self._release)
