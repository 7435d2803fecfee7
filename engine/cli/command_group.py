"""The commands, each imported on first use: each needs a different part of the engine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup
from typer.main import get_command, get_group

_IMPORT_PATHS = {
    "new": "engine.cli.commands.documents.new_project:new",
    "examples": "engine.cli.commands.documents.new_project:examples",
    "run": "engine.cli.commands.run:run",
    "resume": "engine.cli.commands.resume:resume",
    "stop": "engine.cli.main:stop",
    "runs": "engine.cli.commands.runs:app",
    "check": "engine.cli.commands.check:check",
    "adapt": "engine.cli.commands.documents.adapt:adapt_behavior",
    "replay": "engine.cli.commands.replay:replay",
    "sweep": "engine.cli.commands.sweep:app",
    "export": "engine.cli.commands.documents.export:export",
    "picture": "engine.cli.commands.documents.picture:picture",
    "serve": "engine.cli.commands.serve:serve",
    "login": "engine.cli.commands.login:login",
    "coverage": "engine.cli.commands.coverage:app",
    "states": "engine.cli.commands.states:app",
    "doctor": "engine.cli.commands.doctor:doctor",
    "store": "engine.cli.commands.store:app",
    "bus": "engine.cli.commands.bus:app",
    "devices": "engine.cli.commands.devices.devices:devices",
    "emulate": "engine.cli.commands.devices.emulate:emulate",
    "equipment": "engine.cli.commands.devices.equipment:app",
    "reconcell": "engine.cli.commands.devices.reconcell:app",
    "cell": "engine.cli.commands.cell:app",
    "teach": "engine.cli.commands.teach:app",
    "schema": "engine.cli.commands.schema:schema",
}
"""Import path of each command's function, or of the application of a command group."""


def preload(names: Iterable[str]) -> None:
    """Load the commands of these names; the command line itself rejects a name that is no command."""
    for name in names:
        if name in _IMPORT_PATHS:
            _load_command(name)


class Commands(TyperGroup):
    """All commands of `flexcell`, in the order in which the help lists them."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.commands: Any = _CommandsOnDemand()


class _CommandsOnDemand(Mapping[str, Any]):
    """The commands by name; looking up a command imports its module."""

    def __getitem__(self, name: str) -> Any:
        return _load_command(name)

    def __iter__(self) -> Iterator[str]:
        return iter(_IMPORT_PATHS)

    def __len__(self) -> int:
        return len(_IMPORT_PATHS)


@cache
def _load_command(name: str) -> Any:
    module, _, attribute = _IMPORT_PATHS[name].partition(":")
    command = getattr(import_module(module), attribute)
    if isinstance(command, typer.Typer):
        group: Any = get_group(command)
        group.name = name
        return group
    single = typer.Typer(add_completion=False)
    single.command(name)(command)
    return get_command(single)
