"""`flexcell bus`: inspects the skill bus of a running server, or of a cell that the command opens itself."""

from __future__ import annotations

import asyncio
import math
import sys
from collections.abc import AsyncGenerator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Annotated

import click
import msgspec
import typer
from rich.console import Console
from rich.table import Table

from engine.bus import GoalStatus
from engine.bus.json_bus import JsonBus, LocalJsonBus
from engine.bus.remote_bus import RemoteJsonBus
from engine.cause_chain import describe_cause
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_json
from engine.document.cell import load_cell
from engine.errors import FlexcellError
from engine.host.state_folder_names import STATE_FOLDER

app = typer.Typer(
    help="Inspect and use the skill bus of a running server or, with --cell, of a cell.", no_args_is_help=True
)

Cell = Annotated[
    Path | None, typer.Option("--cell", help="Open this cell for the command instead of using the running server.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Folder = Annotated[Path, typer.Option("--server", help="Folder in which `flexcell serve` keeps its state.")]
_STATE = Path(STATE_FOLDER)


@app.command("list")
def list_(cell: Cell = None, server: Folder = _STATE, json: AsJson = False) -> None:
    """List topics, services, actions, parameters and leases."""

    async def main() -> None:
        async with _bus(cell, server) as bus:
            entries = await bus.listing()
        if json:
            sys.stdout.write(msgspec.json.encode(entries).decode() + "\n")
            return
        table = Table("kind", "name", "type", "now", box=None)
        for entry in entries:
            table.add_row(entry.kind, entry.name, entry.type, entry.detail)
        Console().print(table)

    asyncio.run(main())


@app.command("echo")
def echo(
    topic: Annotated[str, typer.Argument(help="Topic, such as left/joint_state.")],
    count: Annotated[
        int, typer.Option("-n", "--count", help="Number of messages to print; 0: until Ctrl-C.", min=0)
    ] = 0,
    cell: Cell = None,
    server: Folder = _STATE,
) -> None:
    """Print the messages of a topic, one JSON object per line, beginning with the latest one."""

    async def main() -> None:
        async with _bus(cell, server) as bus:
            printed = 0
            async for message in bus.echo(topic):
                sys.stdout.write(message + "\n")
                sys.stdout.flush()
                printed += 1
                if printed == count:
                    return

    _until_interrupted(main())


@app.command("hz")
def hz(
    topic: Annotated[str, typer.Argument(help="Topic, such as left/joint_state.")],
    seconds: Annotated[float, typer.Option(help="Duration of the measurement in seconds.", min=0.1)] = 2.0,
    cell: Cell = None,
    server: Folder = _STATE,
) -> None:
    """Measure the rate of a topic."""

    async def main() -> None:
        loop = asyncio.get_running_loop()
        arrivals: list[float] = []
        async with _bus(cell, server) as bus:
            try:
                async with asyncio.timeout(seconds):
                    async for _ in bus.echo(topic):
                        arrivals.append(loop.time())  # noqa: PERF401 - what has arrived stays when time is over
            except TimeoutError:
                pass  # the measurement has ended
        # The first message is the latest one published before the measurement.
        fresh = arrivals[1:]
        rate = (len(fresh) - 1) / (fresh[-1] - fresh[0]) if len(fresh) > 1 else 0.0
        sys.stdout.write(f"{rate:.1f} Hz, {len(fresh)} messages in {seconds:g} s\n")

    _until_interrupted(main())


@app.command("publish")
def publish(
    topic: Annotated[
        str, typer.Argument(help="Topic that accepts commands, such as left/jog; see `flexcell bus list`.")
    ],
    message: Annotated[str, typer.Argument(help="The message as a JSON object.")],
    rate: Annotated[float | None, typer.Option(help="Repeat the message at this rate in Hz.", min=0.1)] = None,
    seconds: Annotated[float | None, typer.Option("--for", help="With --rate: stop after this many seconds.")] = None,
    cell: Cell = None,
    server: Folder = _STATE,
) -> None:
    """Publish a message on a topic that accepts commands, once or at a rate until Ctrl-C. This may move a robot.

    `flexcell bus publish left/jog '{"velocity": [0, 0, -0.02, 0, 0, 0]}' --rate 20 --for 2`
    """
    typed = read_json(message, "the message")
    if seconds is not None and rate is None:
        raise FlexcellError(
            "--for requires --rate", hint="give the rate at which the message is repeated, such as --rate 20"
        )

    async def main() -> None:
        async with _bus(cell, server) as bus:
            if rate is None:
                await bus.publish(topic, typed)
            else:
                await repeat(lambda: bus.publish(topic, typed), rate_hz=rate, duration_s=seconds)

    _until_interrupted(main())


@app.command("keys")
def keys(
    topic: Annotated[str, typer.Argument(help="Topic of the cell for texts, such as operator/key.")],
    cell: Cell = None,
    server: Folder = _STATE,
) -> None:
    """Publish each key that is pressed in this terminal as a value of a topic, until Ctrl-C or Ctrl-D.

    A behavior that waits for the topic reacts to the keys. Without a terminal every character of the input is a key.
    """

    async def main() -> None:
        async with _bus(cell, server) as bus:
            sys.stderr.write(f"each key is published on {topic}; Ctrl-D ends\n")
            while key := await asyncio.to_thread(_next_key):
                await bus.publish(topic, {"value": key})
                sys.stdout.write(f"{key!r}\n")
                sys.stdout.flush()

    _until_interrupted(main())


async def repeat(act: Callable[[], Awaitable[None]], *, rate_hz: float, duration_s: float | None) -> None:
    """Call `act` at a rate; if a call takes too long, the missed calls are skipped."""
    loop = asyncio.get_running_loop()
    start_s, beat = loop.time(), 0
    while duration_s is None or beat / rate_hz < duration_s:
        await act()
        beat = max(beat + 1, math.ceil((loop.time() - start_s) * rate_hz))
        await asyncio.sleep(start_s + beat / rate_hz - loop.time())


@app.command("call")
def call(
    address: Annotated[str, typer.Argument(help="Service, such as left/forward_kinematics.")],
    request: Annotated[str, typer.Argument(help="The request as a JSON object.")] = "{}",
    cell: Cell = None,
    server: Folder = _STATE,
) -> None:
    """Call a service and print its response as JSON."""

    async def main() -> None:
        async with _bus(cell, server) as bus:
            sys.stdout.write(await bus.call(address, read_json(request, "the request")) + "\n")

    asyncio.run(main())


@app.command("goal")
def goal(
    address: Annotated[str, typer.Argument(help="Action, such as left/joint_trap_vel.")],
    request: Annotated[str, typer.Argument(help="The goal as a JSON object.")] = "{}",
    cell: Cell = None,
    server: Folder = _STATE,
) -> None:
    """Send an action goal, wait for its result and print it. This may move a robot."""

    async def main() -> ExitCode:
        async with _bus(cell, server) as bus:
            end = await bus.perform(address, read_json(request, "the goal"))
        sys.stdout.write(msgspec.json.encode({"status": end.status.value, "result": end.result}).decode() + "\n")
        if end.status is GoalStatus.SUCCEEDED:
            return ExitCode.SUCCESS
        sys.stderr.write(f"{end.status.value}: {describe_cause(end.cause) if end.cause else 'no reason given'}\n")
        return ExitCode.OTHER_OUTCOME

    raise typer.Exit(asyncio.run(main()))


@asynccontextmanager
async def _bus(cell: Path | None, server: Path) -> AsyncGenerator[JsonBus]:
    if cell is None:
        async with RemoteJsonBus.connect(server) as remote:
            yield remote
    else:
        # Imported here: a command to a server needs nothing that executes runs.
        from engine.project.cell_runner import open_cell

        async with open_cell(load_cell(cell)) as opened:
            yield LocalJsonBus(opened.bus)


def _next_key() -> str:
    """Wait for a key; empty at the end of the input."""
    if not sys.stdin.isatty():
        return sys.stdin.read(1)
    try:
        return click.getchar()
    except EOFError:
        return ""


def _until_interrupted(main: object) -> None:
    try:
        asyncio.run(main)  # pyright: ignore[reportArgumentType]
    except KeyboardInterrupt:
        raise typer.Exit(ExitCode.INTERRUPTED) from None
