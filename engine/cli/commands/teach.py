"""`flexcell teach`: uses the Helping Hand of a running server, and connects its buttons."""

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
from engine.cli.commands.teach_propose import propose
from engine.cli.exit_code import ExitCode
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
    help="Teach poses and motions: set triggers, capture, save captures as named entries.", no_args_is_help=True
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
    triggers: Annotated[Path, typer.Argument(help="Trigger document, which defines the action of each button.")],
    server: Folder = _STATE,
) -> None:
    """Activate the triggers of a document in the Helping Hand.

    `flexcell teach set triggers.yaml`
    """
    _show(_call(server, SetTriggers(triggers=load_triggers(triggers)), TeachStatus), json=False)


@app.command("status")
def status(server: Folder = _STATE, json: AsJson = False) -> None:
    """Show the triggers and captures."""
    _show(_call(server, ReadTeachStatus(), TeachStatus), json=json)


@app.command("fire")
def fire(
    trigger: Annotated[str, typer.Argument(help="Name of the trigger.")],
    release: Annotated[bool, typer.Option("--release", help="Release the button instead of pressing it.")] = False,
    server: Folder = _STATE,
) -> None:
    """Execute the action of a trigger without its button. This may start hand guiding of an arm.

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
        CaptureForm | None, typer.Option("--as", help="Form of the entry; by default the form of the capture.")
    ] = None,
    tag: Annotated[list[str] | None, typer.Option(help="Tag of the entry; may be repeated.")] = None,
    replace: Annotated[bool, typer.Option("--replace", help="Overwrite an entry of this name.")] = False,
    by: Annotated[str, typer.Option(help="Author, for the history of the entry.")] = "",
    reason: Annotated[str, typer.Option(help="Reason, for the history of the entry.")] = "",
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
    """Delete a capture."""
    _show(_call(server, DiscardCapture(id=number), TeachStatus), json=False)


@app.command("buttons")
def buttons(
    device: Annotated[Path, typer.Argument(help="Event file, such as /dev/input/by-id/…-event-kbd.")],
    topic: Annotated[str, typer.Option(help="Button events are published on <topic>/<button>.")] = "keypress",
    server: Folder = _STATE,
) -> None:
    """Publish the buttons of an input device, such as a media controller, until it is removed or Ctrl-C.

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
    sys.stderr.write("the device was removed\n")


def _call(server: Path, request: Service[R], kind: type[R]) -> R:
    return asyncio.run(_with_bus(server, lambda bus: _call_service(bus, request, kind)))


async def _call_service(bus: RemoteJsonBus, request: Service[R], kind: type[R]) -> R:
    answer = await bus.call(f"{_NAMESPACE}/{request.skill_name()}", msgspec.to_builtins(request))
    return msgspec.json.decode(answer, type=kind)


async def _with_bus(server: Path, ask: Callable[[RemoteJsonBus], Awaitable[R]]) -> R:
    async with RemoteJsonBus.connect(server) as bus:
        return await ask(bus)


def _show(teach_status: TeachStatus, *, json: bool) -> None:
    if json:
        sys.stdout.write(msgspec.json.encode(teach_status).decode() + "\n")
        return
    console = Console()
    triggers = Table("trigger", "robot", "topic", "type", "action", "state", box=None)
    for one in teach_status.triggers:
        trigger = one.trigger
        state = one.fault or ("pressed" if one.pressed else "")
        triggers.add_row(
            trigger.trig_name, trigger.robot_ns, trigger.trig_topic, trigger.trig_type, trigger.trig_callback, state
        )
    console.print(triggers if teach_status.triggers else "no triggers: `flexcell teach set FILE`")
    captures = Table("capture", "robot", "form", "samples", "seconds", "by trigger", "saved as", box=None)
    for capture in teach_status.captures:
        captures.add_row(
            str(capture.id),
            capture.robot,
            capture.form,
            str(capture.samples or ""),
            f"{capture.duration_s:.2f}" if capture.duration_s else "",
            capture.trigger,
            ", ".join(capture.saved_as) or capture.remark,
        )
    if teach_status.captures:
        console.print(captures)
    for name in teach_status.recording:
        console.print(f"{name} is being recorded")
    for name in teach_status.guided:
        console.print(f"{name} is being guided by hand")
    if teach_status.message:
        console.print(teach_status.message)
