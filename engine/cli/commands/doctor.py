"""`flexcell doctor`: tells what is installed, missing, unwritable, taken or slow."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console
from rich.text import Text

from engine.cli.exit_code import ExitCode
from engine.doctor.examination import Condition, Examination
from engine.doctor.host_machine import machine
from engine.doctor.installation import installation
from engine.doctor.server_place import server_place
from engine.host.loopback import DASHBOARD_PORT
from engine.host.state_folder_names import STATE_FOLDER
from engine.host.user_cache import cache_dir

_MARKS: dict[Condition, tuple[str, str]] = {
    "ok": ("ok", "green"),
    "note": ("note", "yellow"),
    "problem": ("problem", "red"),
}


def doctor(
    state: Annotated[Path, typer.Option(help="Folder in which a server would keep its state.")] = Path(STATE_FOLDER),
    host: Annotated[str, typer.Option(help="Loopback address of the server.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="TCP port of the server.", min=1, max=65535)] = DASHBOARD_PORT,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Tell what is installed and missing, what cannot be written, which port is taken, and how the machine is.

    Exit code 1 if something that every user needs does not work. Nothing is changed, and no device is connected.
    """
    found = [*installation(), *server_place(state, cache=cache_dir(), host=host, port=port), *machine()]
    if json:
        sys.stdout.write(f"{msgspec.json.encode(found).decode()}\n")
    else:
        _print(found)
    if any(each.condition == "problem" for each in found):
        raise typer.Exit(ExitCode.OTHER_OUTCOME)


def _print(found: list[Examination]) -> None:
    console = Console(soft_wrap=True)
    width = max(len(each.subject) for each in found)
    for group in dict.fromkeys(each.group for each in found):
        console.print(Text(group.capitalize(), style="bold"))
        for each in (one for one in found if one.group == group):
            word, colour = _MARKS[each.condition]
            line = Text.assemble("  ", (f"{word:<8}", colour), f"{each.subject:<{width}}  {each.state}")
            console.print(line)
            if each.advice:
                console.print(Text(f"{'':{width + 12}}{each.advice}", style="dim"))
    notes = sum(each.condition == "note" for each in found)
    problems = sum(each.condition == "problem" for each in found)
    console.print(
        f"{problems or 'No'} problem{'' if problems == 1 else 's'}, {notes or 'no'} note{'' if notes == 1 else 's'}."
    )
