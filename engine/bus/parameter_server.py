"""Typed parameters of devices and services, declared once and validated at every change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import msgspec

from engine.errors import BusError
from engine.wording.misfit import explain_misfit


@dataclass(frozen=True)
class BusParameter:
    """One declared parameter and its present value."""

    name: str
    kind: Any
    value: object
    description: str


class ParameterServer:
    """All parameters of one bus by name, such as `left/impedance/stiffness`."""

    def __init__(self) -> None:
        self._parameters: dict[str, BusParameter] = {}
        self._watchers: dict[str, list[Callable[[object], None]]] = {}

    def declare(self, name: str, kind: Any, default: object, *, description: str = "") -> None:
        """Declare a parameter; `kind` is any type that msgspec validates.

        Raises:
            BusError: the parameter exists, or the default is not of its type.
        """
        if name in self._parameters:
            raise BusError("this parameter is already declared", where=name)
        self._parameters[name] = BusParameter(name, kind, _converted(name, kind, default), description)

    def get(self, name: str) -> object:
        """Return the present value."""
        return self._known(name).value

    def set(self, name: str, value: object) -> None:
        """Validate and store a value, then notify the watchers."""
        known = self._known(name)
        checked = _converted(name, known.kind, value)
        self._parameters[name] = BusParameter(name, known.kind, checked, known.description)
        for watcher in self._watchers.get(name, ()):
            watcher(checked)

    def watch(self, name: str, watcher: Callable[[object], None]) -> None:
        """Call `watcher` with each new value."""
        self._known(name)
        self._watchers.setdefault(name, []).append(watcher)

    def listing(self) -> tuple[BusParameter, ...]:
        """Return all parameters by name."""
        return tuple(self._parameters[name] for name in sorted(self._parameters))

    def _known(self, name: str) -> BusParameter:
        try:
            return self._parameters[name]
        except KeyError:
            raise BusError("no such parameter", where=name, hint="`flexcell bus list` lists the parameters") from None


def _converted(name: str, kind: Any, value: object) -> object:
    try:
        return msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        raise BusError(explain_misfit(error, kind), where=name) from error
