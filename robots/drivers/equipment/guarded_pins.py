"""Pins with a guard: outputs are at their safe values unless a client that controls has set them otherwise."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from engine.document.equipment import DigitalInputPin, DigitalOutputPin, EquipmentDocument, PwmPin
from engine.errors import RobotError
from engine.wording import did_you_mean
from robots.drivers.equipment.backends.new_transport import new_pin_transport
from robots.drivers.equipment.backends.pin_values import PinCommand, PinReading, PinValue, PinValues, differing
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming

_PERIOD_S = 0.02
_STALE_S = 0.5
_CONFIRM_S = 1.0


class GuardedPins:
    """The pins of one document; listens to its link. Its thread makes them safe if the event loop is silent.

    Args:
        document: What is served.
        lost: Called with the reason when the pins are not reached any more; whoever controlled has to ask anew.
    """

    def __init__(self, document: EquipmentDocument, lost: Callable[[str], None]) -> None:
        self.document = document
        self._lost = lost
        self._read = asyncio.Event()
        timing = LinkTiming(period_s=_PERIOD_S, stale_s=_STALE_S, silence_s=document.silence_s)
        self._link = FreshLink(new_pin_transport(document), self, timing)
        self._safe = PinCommand(values=document.safe_values)
        self._commands = 0

    @property
    def problem(self) -> str:
        """Why nothing is known of the pins; empty if they are read."""
        try:
            self._link.fresh()
        except RobotError as error:
            return str(error)
        return ""

    @property
    def values(self) -> PinValues:
        """All pins; empty while `problem` says why."""
        try:
            return self._link.fresh().values
        except RobotError:
            return {}

    @property
    def age_s(self) -> float:
        """Age of the values in seconds."""
        return min(self._link.age_s(), 3600.0)

    async def open(self) -> None:
        """Reach the pins; outputs are at their safe values. Raises RobotError."""
        await self._link.start()
        await self.make_safe()

    async def close(self) -> None:
        """Make outputs safe and let the pins go."""
        try:
            await self.make_safe()
        except RobotError:
            pass  # they are not reached: opening them again makes them safe
        finally:
            await self._link.close()

    async def make_safe(self) -> None:
        """Set all outputs to their safe values; raises RobotError where they are not read back."""
        await self._set(self._safe.values)

    def begin_safe(self) -> None:
        """Have all outputs set to their safe values before any later command, without waiting."""
        self._link.arm(None)
        self._commands += 1
        # A failure is that of the link, which is opened anew with safe values.
        self._link.submit(self._safe).add_done_callback(lambda done: done.exception())

    def watch(self) -> None:
        """Have the thread make outputs safe when the event loop is silent: a client controls now."""
        self._link.arm(self._safe)

    async def set(self, values: PinValues) -> None:
        """Set outputs and return when they are read back.

        Raises:
            RobotError: there is no such output, it is read back otherwise, or the pins are not reached.
        """
        await self._set({name: self._checked(name, value) for name, value in values.items()})

    async def stop(self) -> None:
        """Set the outputs that STOP makes safe."""
        if self.document.stop_values:
            await self._set(self.document.stop_values)

    async def _set(self, values: PinValues) -> None:
        self._commands += 1
        command = self._commands
        try:
            latest = await asyncio.wait_for(self._confirmed(values), _CONFIRM_S)
        except TimeoutError as error:
            reason = "the pins did not answer in time; outputs may be set or not"
            raise RobotError(reason, where=self._link.transport.address, hint=self._link.transport.remedy) from error
        wrong = differing(values, latest.value.values)
        if command != self._commands:
            raise RobotError("another command came before this one was read back", where=self._link.transport.address)
        if wrong:
            words = ", ".join(f"`{name}` is {latest.value.values[name]}" for name in wrong)
            hint = "check what is connected to these outputs, and whether another program sets them"
            raise RobotError(f"outputs are read back with other values: {words}", hint=hint)

    async def _confirmed(self, values: PinValues) -> FreshReading[PinReading]:
        """Set outputs and return the first reading that was requested afterwards."""
        acknowledged_s = await self._link.submit(PinCommand(values=values))
        while (latest := self._link.latest) is None or latest.asked_s < acknowledged_s:
            self._link.fresh()
            self._read.clear()
            await self._read.wait()
        return latest

    def _checked(self, name: str, value: PinValue) -> PinValue:
        pin = self.document.pins.get(name)
        if pin is None:
            hint = did_you_mean(name, self.document.pins)
            raise RobotError(f"{self.document.equipment} has no pin `{name}`", hint=hint)
        match pin:
            case DigitalInputPin():
                raise RobotError(f"`{name}` is an input", hint="set outputs only")
            case DigitalOutputPin() if not isinstance(value, bool):
                raise RobotError(f"`{name}` is on or off and not {value}", hint="give true or false")
            case PwmPin() if isinstance(value, bool) or not 0.0 <= value <= 1.0:
                raise RobotError(f"the duty of `{name}` is no {value}", hint="give a number from 0 to 1")
            case _:
                return value

    def read(self, reading: FreshReading[PinReading]) -> None:
        """Take a reading."""
        self._read.set()

    def lost(self, reason: str) -> None:
        """Tell that the pins are not reached."""
        self._read.set()
        self._link.arm(None)
        self._lost(reason)

    def found(self) -> None:
        """Nothing to do: opening the pins again has set their safe values."""

    def stopped_by_silence(self, silent_s: float) -> None:
        """Note that the thread has made the outputs safe: what was commanded does not return."""
        self._commands += 1
        self._lost(f"the event loop of the server was silent for {silent_s:.2f} s")
