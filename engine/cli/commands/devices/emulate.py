"""`flexcell emulate`: runs the emulator of a device, which speaks its protocol on loopback."""

from __future__ import annotations

import asyncio
import signal
import sys
from collections.abc import Mapping
from typing import Annotated

import msgspec
import typer

from engine.cell.drivers import Emulator, EmulatorOptions, emulator, installed_emulators
from engine.cli.inputs import read_pairs
from engine.errors import FlexcellError


def emulate(
    kind: Annotated[str, typer.Argument(help="Kind of device, such as robotiq; see --list.")] = "",
    options: Annotated[
        list[str] | None, typer.Argument(help="Options of the emulator as name=value, such as port=0.")
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List the emulators and their options.")] = False,
) -> None:
    """Emulate a device until Ctrl-C; prints one JSON line with its address and its side channel when it is ready.

    `flexcell emulate robotiq connection=urcap host=127.0.0.5 port=63352 object_m=0.03`

    The side channel takes JSON lines, such as {"do": "freeze"}: see docs/how-to/connect-a-robotiq-gripper.md.
    """
    if listed:
        sys.stdout.write("".join(_description(each) for each in installed_emulators()))
        return
    if not kind:
        raise FlexcellError("name the kind of device", hint="flexcell emulate --list")
    chosen = emulator(kind)
    asyncio.run(_serve(chosen, chosen.read_options(read_pairs(options or (), f"emulate {kind}"))))


async def _serve(chosen: Emulator, options: EmulatorOptions) -> None:
    task = asyncio.ensure_future(chosen.run(options, _ready))
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, task.cancel)
    try:
        await task
    except asyncio.CancelledError:
        return


def _ready(place: Mapping[str, object]) -> None:
    sys.stdout.write(msgspec.json.encode({"ready": place}).decode() + "\n")
    sys.stdout.flush()


def _description(each: Emulator) -> str:
    lines = "".join(f"  {name}={text}\n" for name, text in each.described().items())
    return f"{each.kind}: {each.summary}\n{lines}"
