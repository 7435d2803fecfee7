"""The commands, each loaded when it is asked for: every one needs another part of the engine."""

from __future__ import annotations

from collections.abc import Iterator, MutableMapping
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup
from typer.main import get_command, get_group

_PLACES = {
    "run": "engine.cli.run:run",
    "resume": "engine.cli.resume:resume",
    "stop": "engine.cli.main:stop",
    "runs": "engine.cli.runs:app",
    "check": "engine.cli.check:check",
    "replay": "engine.cli.replay:replay",
    "export": "engine.cli.export:export",
    "serve": "engine.cli.serve:serve",
    "login": "engine.cli.login:login",
    "coverage": "engine.cli.coverage:app",
    "states": "engine.cli.states:app",
    "store": "engine.cli.store:app",
    "bus": "engine.cli.bus:app",
    "cell": "engine.cli.cell:app",
    "teach": "engine.cli.teach:app",
    "schema": "engine.cli.schema:schema",
}
"""Where the function of a command, or the application of a group of them, is."""


class Commands(TyperGroup):
    """All commands of `flexcell`, in the order of its help."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.commands = _CommandsOnDemand()


class _CommandsOnDemand(MutableMapping[str, Any]):
    """The commands by name; a module is imported when its command is looked up."""

    def __init__(self) -> None:
        self._loaded: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._loaded:
            self._loaded[name] = _loaded(name)
        return self._loaded[name]

    def __setitem__(self, name: str, command: Any) -> None:
        self._loaded[name] = command

    def __delitem__(self, name: str) -> None:
        del self._loaded[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*_PLACES, *self._loaded)))

    def __len__(self) -> int:
        return len(set(_PLACES) | set(self._loaded))

    def __contains__(self, name: object) -> bool:
        return name in _PLACES or name in self._loaded


def _loaded(name: str) -> Any:
    module, _, attribute = _PLACES[name].partition(":")
    found = getattr(import_module(module), attribute)
    if isinstance(found, typer.Typer):
        command: Any = get_group(found)
        command.name = name
        return command
    single = typer.Typer(add_completion=False)
    single.command(name)(found)
    return get_command(single)
