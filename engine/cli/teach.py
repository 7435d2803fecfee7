"""`flexcell teach`: the Helping Hand of a running server from the command line, and buttons for it."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Annotated, TypeVar

import msgspec
import typer
from rich.console import Console
from rich.table import Table

from engine.bus.remote_bus import RemoteJsonBus
from engine.cli.exit_code import ExitCode
from engine.cli.teach_propose import propose
from engine.errors import BusError
from engine.skill import Service
from engine.skills.entries import EntryRecord
from engine.skills.teaching import (
    ButtonState,
    Capture,
    CaptureForm,
    DiscardCapture,
    FireTrigger,
    ReadCapture,
    ReadTeachStatus,
    SaveCapture,
    SetTriggers,
    TeachStatus,
)
from engine.teaching.button_device import button_events
from engine.teaching.teach_document import load_triggers

app = typer.Typer(
    help="Teach poses and motions: triggers, captures, saving them as named entries.", no_args_is_help=True
)

R = TypeVar("R")
Folder = Annotated[Path, typer.Option("--server", help="Folder in which `flexcell serve` keeps its state.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Number = Annotated[int, typer.Argument(help="Number of the capture, see `flexcell teach status`.")]
_STATE = Path(".flexcell")
_NAMESPACE = "teach"
app.command("propose")(propose)


@app.command("set")
def set_(
    triggers: Annotated[Path, typer.Argument(help="Trigger document: what each button does.")], server: Folder = _STATE
) -> None:
    """Let the Helping Hand listen to the triggers of a document.

    `flexcell teach set triggers.yaml`
    """
    _show(_call(server, SetTriggers(triggers=load_triggers(triggers)), TeachStatus), json=False)


@app.command("status")
def status(server: Folder = _STATE, json: AsJson = False) -> None:
    """Show triggers and captures."""
    _show(_call(server, ReadTeachStatus(), TeachStatus), json=json)


@app.command("fire")
def fire(
    trigger: Annotated[str, typer.Argument(help="Name of the trigger.")],
    release: Annotated[bool, typer.Option("--release", help="Let its button go instead of pressing it.")] = False,
    server: Folder = _STATE,
) -> None:
    """Do what a trigger does, without its button. This may let an arm float.

    `flexcell teach fire "Record joint state"`
    """
    _show(_call(server, FireTrigger(trig_name=trigger, pressed=not release), TeachStatus), json=False)


@app.command("show")
def show(number: Number, server: Folder = _STATE) -> None:
    """Print a capture with all its data as JSON."""
    capture = _call(server, ReadCapture(id=number), Capture)
    sys.stdout.write(msgspec.json.format(msgspec.json.encode(capture)).decode() + "\n")


@app.command("save")
def save(
    number: Number,
    name: Annotated[str, typer.Argument(help="Name of the entry.")],
    as_: Annotated[
        CaptureForm | None, typer.Option("--as", help="Form of the entry; as what it was captured otherwise.")
    ] = None,
    tag: Annotated[list[str] | None, typer.Option(help="Tag of the entry; may be repeated.")] = None,
    replace: Annotated[bool, typer.Option("--replace", help="Overwrite an entry of that name.")] = False,
    by: Annotated[str, typer.Option(help="Who saves it, for its history.")] = "",
    reason: Annotated[str, typer.Option(help="Why, for its history.")] = "",
    server: Folder = _STATE,
) -> None:
    """Save a capture as a named entry.

    `flexcell teach save 3 above_tray --as pose --tag station_1`
    """
    request = SaveCapture(id=number, name=name, form=as_, tags=tuple(tag or ()), replace=replace, by=by, reason=reason)
    record = _call(server, request, EntryRecord)
    sys.stdout.write(f"{record.kind} {record.name}, revision {record.revision}\n")


@app.command("discard")
def discard(number: Number, server: Folder = _STATE) -> None:
    """Throw a capture away."""
    _show(_call(server, DiscardCapture(id=number), TeachStatus), json=False)


@app.command("buttons")
def buttons(
    device: Annotated[Path, typer.Argument(help="Event file, such as /dev/input/by-id/…-event-kbd.")],
    topic: Annotated[str, typer.Option(help="Buttons are told on <topic>/<button>.")] = "keypress",
    server: Folder = _STATE,
) -> None:
    """Tell the bus of the buttons of an input device, such as a media controller, until it goes away or Ctrl-C.

    `flexcell teach buttons /dev/input/by-id/bluetooth-media-event-kbd`
    """

    async def main() -> None:
        async with RemoteJsonBus.connect(server) as bus:
            async for event in button_events(device):
                name = f"{topic}/{event.button}"
                try:
                    await bus.publish(name, msgspec.to_builtins(ButtonState(value=event.pressed)))
                except BusError:
                    sys.stderr.write(f"{event.button}: no trigger listens to {name}\n")

    try:
        asyncio.run(main())
    except KeyboardInterrupt:
        raise typer.Exit(ExitCode.INTERRUPTED) from None
    sys.stderr.write("the device went away\n")


def _call(server: Path, request: Service[R], kind: type[R]) -> R:
    return asyncio.run(_with_bus(server, lambda bus: _asked(bus, request, kind)))


async def _asked(bus: RemoteJsonBus, request: Service[R], kind: type[R]) -> R:
    answer = await bus.call(f"{_NAMESPACE}/{request.skill_name()}", msgspec.to_builtins(request))
    return msgspec.json.decode(answer, type=kind)


async def _with_bus(server: Path, ask: Callable[[RemoteJsonBus], Awaitable[R]]) -> R:
    async with RemoteJsonBus.connect(server) as bus:
        return await ask(bus)


def _show(found: TeachStatus, *, json: bool) -> None:
    if json:
        sys.stdout.write(msgspec.json.encode(found).decode() + "\n")
        return
    console = Console()
    triggers = Table("trigger", "robot", "topic", "type", "does", "now", box=None)
    for one in found.triggers:
        trigger = one.trigger
        now = one.fault or ("pressed" if one.pressed else "")
        triggers.add_row(
            trigger.trig_name, trigger.robot_ns, trigger.trig_topic, trigger.trig_type, trigger.trig_callback, now
        )
    console.print(triggers if found.triggers else "no triggers: `flexcell teach set FILE`")
    captures = Table("capture", "robot", "form", "samples", "seconds", "by trigger", "saved as", box=None)
    for capture in found.captures:
        captures.add_row(
            str(capture.id),
            capture.robot,
            capture.form,
            str(capture.samples or ""),
            f"{capture.duration_s:.2f}" if capture.duration_s else "",
            capture.trigger,
            ", ".join(capture.saved_as) or capture.remark,
        )
    if found.captures:
        console.print(captures)
    for name in found.recording:
        console.print(f"{name} is being recorded")
    for name in found.guided:
        console.print(f"{name} floats")
    if found.said:
        console.print(found.said)
