"""`flexcell reconcell`: serves the real-time interface of ReconCell in front of an arm."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Mapping
from contextlib import AbstractAsyncContextManager
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from engine.cli.capture_option import Capture, capture_folder
from engine.cli.exit_code import ExitCode
from engine.cli.terminal.end_signals import end_at_signals
from engine.document.cell import Cell, load_cell
from engine.host.thread_switch_interval import short_switch_interval
from engine.project.cell_runner import open_cell
from engine.registry import SERVERS, load_factory
from engine.stop import StopRelay

NewReconcellServer = Callable[..., AbstractAsyncContextManager[Any]]

app = typer.Typer(
    help="Serve the real-time UDP interface of ReconCell in front of an arm with six joints.", no_args_is_help=True
)


@app.callback()
def group() -> None:
    """Keep `serve` a command of its own."""


@app.command("serve")
def serve_reconcell(
    cell: Annotated[Path, typer.Argument(help="Cell document.")],
    robot: Annotated[str, typer.Option(help="Name of the arm in the cell.")],
    address: Annotated[str, typer.Option(help="IPv4 loopback address of the command ports.")] = "127.0.0.1",
    receiver: Annotated[
        list[str] | None, typer.Option(help="IPv4 address to which the state is sent; may be repeated [127.0.0.1].")
    ] = None,
    rate: Annotated[float, typer.Option(help="Rate of the state packets in Hz.", min=1.0, max=1000.0)] = 125.0,
    quaternion: Annotated[Literal["xyzw", "wxyz"], typer.Option(help="Order of quaternions on the wire.")] = "xyzw",
    commander: Annotated[
        Literal["socket", "host"],
        typer.Option(help="What a sender is known by: address and port, or its address alone."),
    ] = "socket",
    silence: Annotated[
        float,
        typer.Option(
            help="Longest silence of the sender during a motion in seconds; 0: motions end without it.", min=0
        ),
    ] = 0.0,
    capture: Capture = None,
    seed: Annotated[
        int | None, typer.Option(help="Seed of the placement noise of parts; without a seed, no noise.", min=0)
    ] = None,
) -> None:
    """Open a cell and serve the interface until Ctrl-C; the arm is brought to rest before the command exits.

    `flexcell reconcell serve behaviors/cells/ur10.yaml --robot arm`

    In a cell with runs and a dashboard: `flexcell serve --reconcell arm=127.0.0.1`.
    """
    folder = capture_folder(capture)
    options: dict[str, object] = {
        "address": address,
        "receivers": tuple(receiver or ("127.0.0.1",)),
        "rate_hz": rate,
        "quaternion": quaternion,
        "commander": commander,
        "silence_s": silence,
        "capture": str(folder) if folder is not None else "",
    }
    asyncio.run(_serve(load_cell(cell), robot, options, seed=seed, capture=folder))
    raise typer.Exit(ExitCode.INTERRUPTED)


async def _serve(
    cell: Cell, robot: str, options: Mapping[str, object], *, seed: int | None, capture: Path | None
) -> None:
    new_server: NewReconcellServer = load_factory(SERVERS, "reconcell")
    relay = StopRelay()
    ended = asyncio.Event()
    with short_switch_interval():
        async with (
            open_cell(cell, seed=seed, relay=relay, capture=capture) as opened,
            new_server(opened.bus, robot, **options),
        ):
            sys.stdout.write(f"{robot} of {opened.name} is served at {options['address']}; Ctrl-C ends\n")
            sys.stdout.flush()
            end_at_signals(ended.set)
            with relay.watched_signals(at_once=True):
                await ended.wait()
