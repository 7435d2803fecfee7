"""The commands, each loaded when it is asked for: every one needs another part of the engine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
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


def preload(names: Iterable[str]) -> None:
    """Load the commands of these names; what is none is left for the command line to refuse."""
    for name in names:
        if name in _PLACES:
            _loaded(name)


class Commands(TyperGroup):
    """All commands of `flexcell`, in the order of its help."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.commands: Any = _CommandsOnDemand()


class _CommandsOnDemand(Mapping[str, Any]):
    """The commands by name; a module is imported when its command is looked up."""

    def __getitem__(self, name: str) -> Any:
        return _loaded(name)

    def __iter__(self) -> Iterator[str]:
        return iter(_PLACES)

    def __len__(self) -> int:
        return len(_PLACES)


@cache
def _loaded(name: str) -> Any:
    module, _, attribute = _PLACES[name].partition(":")
    found = getattr(import_module(module), attribute)
    if isinstance(found, typer.Typer):
        group: Any = get_group(found)
        group.name = name
        return group
    single = typer.Typer(add_completion=False)
    single.command(name)(found)
    return get_command(single)
