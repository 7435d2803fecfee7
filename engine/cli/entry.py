"""The console script: sends STOP before it imports anything else."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from pathlib import Path


def main() -> None:
    """Run the command line; plain `flexcell stop` and `--version` run without loading the other commands."""
    if sys.argv[1:2] == ["stop"] and (options := _stop_options(sys.argv[2:])) is not None:
        from engine.cli.commands.stop import stop_cell

        sys.exit(stop_cell(*options))
    if sys.argv[1:] == ["--version"]:
        from importlib.metadata import version

        sys.stdout.write(f"flexcell {version('flexcell')}\n")
        return
    command_line = _command_line()
    try:
        command_line()
    finally:
        # At exit, Python would search everything that a cell loaded for cycles, for 0.3 s of CPU time.
        gc.freeze()


def _command_line() -> Callable[[], None]:
    """Return the full command line, with the module of the requested command loaded.

    Garbage collection is off during the imports, and the imported objects are frozen: none of them becomes garbage,
    and collecting takes a sixth of the time of a small command. Other threads begin later.
    """
    gc.disable()
    try:
        from engine.cli.command_group import preload
        from engine.cli.main import main as command_line
        from engine.host.garbage_collection import set_up_collector

        preload(sys.argv[1:2])
        set_up_collector()
    finally:
        gc.freeze()
        gc.enable()
    return command_line


def _stop_options(arguments: list[str]) -> tuple[Path, str] | None:
    """Return state folder and reason; None for arguments that need the full command line, such as --help."""
    from engine.cli.commands.stop import REASON
    from engine.host.state_folder_names import STATE_FOLDER

    given = {"--state": STATE_FOLDER, "--reason": REASON}
    names, values = arguments[0::2], arguments[1::2]
    if len(names) != len(values) or any(name not in given for name in names):
        return None
    given.update(zip(names, values, strict=True))
    return Path(given["--state"]), given["--reason"]
