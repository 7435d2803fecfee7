"""The contract of an emulator: a program beside a driver that speaks the protocol of the device on loopback."""

from __future__ import annotations

import importlib
import re
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import cast

import msgspec

from engine.cell.drivers.driver import DriverOptions
from engine.document import StrictModel
from engine.errors import FlexcellError, RegistryError
from engine.registry import load_factory, registered_names
from engine.wording.suggestions import did_you_mean

EMULATORS = "flexcell.emulators"
# The words of asyncio, whose error has the address nowhere else.
_BOUND = re.compile(r"\('(?P<host>[^']+)', (?P<port>\d+)[^)]*\): (?:\[[^]]*\] )?(?P<reason>.+)")


class EmulatorOptions(StrictModel, frozen=True, kw_only=True):
    """Base of the options of emulators: fields with descriptions and defaults."""


Ready = Callable[[Mapping[str, object]], None]
"""Receives where the emulator listens once it does."""


@dataclass(frozen=True, kw_only=True)
class Emulator:
    """An emulator, as the entry point `flexcell.emulators` of its name offers it.

    Attributes:
        kind: Its name.
        summary: What it emulates and what not, in one line.
        options: Its options.
        serve: Where its coroutine function is found, `module:NAME`: it receives options and `ready`, and `plant` if
            it shall move joints of others; it serves, and ends when it is cancelled.
        for_driver: Where the function is found that returns its options for the options of the driver of this name
            and the name of the device's model; empty for an emulator that has no place in an emulated cell.
    """

    kind: str
    summary: str
    options: type[EmulatorOptions]
    serve: str
    for_driver: str = ""

    def read_options(self, given: Mapping[str, str]) -> EmulatorOptions:
        """Return the options given as texts.

        Raises:
            FlexcellError: there is no such option, or its value is not valid.
        """
        known = self.described()
        for name in given:
            if name not in known:
                raise FlexcellError(f"{self.kind} has no option `{name}`", hint=did_you_mean(name, known))
        try:
            return msgspec.convert(given, self.options, strict=False)
        except msgspec.ValidationError as error:
            raise FlexcellError(f"the emulator {self.kind}: {error}", hint="flexcell emulate --list") from error

    def described(self) -> dict[str, str]:
        """Return each option with its default and description."""
        schema = msgspec.json.schema(self.options)
        properties = schema["$defs"][self.options.__name__]["properties"]
        return {
            name: f"{entry.get('default', '')!s}: {entry.get('description', '')}" for name, entry in properties.items()
        }

    def options_for(self, driver: DriverOptions, *, model: str) -> EmulatorOptions:
        """Return the options of the emulated device that a driver with these options is for.

        Raises:
            FlexcellError: it belongs to no driver, or cannot be where the options say.
        """
        if not self.for_driver:
            hint = f"simulate this device, or emulate it alone: flexcell emulate {self.kind}"
            raise FlexcellError(f"a device of kind {self.kind} cannot be part of an emulated cell", hint=hint)
        return cast("EmulatorOptions", _found(self.for_driver)(driver, model))

    async def run(self, options: EmulatorOptions, ready: Ready, **plant: object) -> None:
        """Serve until this is cancelled; with a `plant` it moves joints of others.

        Raises:
            FlexcellError: it cannot listen where the options say, or cannot be what they say.
        """
        places: list[Mapping[str, object]] = []

        def note(place: Mapping[str, object]) -> None:
            places.append(place)
            ready(place)

        try:
            await cast("Awaitable[None]", _found(self.serve)(options, note, **plant))
        except (OSError, ExceptionGroup) as failed:
            error = _only_error(failed)
            if isinstance(error, FlexcellError):
                raise error from failed
            if places or not isinstance(error, OSError):
                raise
            raise _cannot_listen(error, self.kind) from error


def _only_error(failed: Exception) -> Exception:
    """Return what alone has ended a group of tasks; the group where there is more."""
    if not isinstance(failed, ExceptionGroup):
        return failed
    group = cast("ExceptionGroup[Exception]", failed)
    return _only_error(group.exceptions[0]) if len(group.exceptions) == 1 else group


def _cannot_listen(error: OSError, kind: str) -> FlexcellError:
    reason = error.strerror or str(error)
    bound = _BOUND.search(reason)
    where, why = (f" at {bound['host']}:{bound['port']}", bound["reason"]) if bound else ("", reason)
    hint = "another emulator or program may be there, `ss -ltnp` names it: end it, or choose another host or port"
    return FlexcellError(f"the emulator {kind} cannot listen{where}: {why}", hint=hint)


def _found(place: str) -> Callable[..., object]:
    module, _, attribute = place.partition(":")
    return cast("Callable[..., object]", getattr(importlib.import_module(module), attribute))


def emulator(kind: str) -> Emulator:
    """Return an emulator by name; raises RegistryError with similar names where there is none."""
    offered = load_factory(EMULATORS, kind)
    if not isinstance(offered, Emulator):
        raise RegistryError(f"the entry point of the emulator {kind} offers none", where=kind)
    return offered


def installed_emulators() -> tuple[Emulator, ...]:
    """Return all emulators, by name."""
    return tuple(emulator(kind) for kind in registered_names(EMULATORS))
