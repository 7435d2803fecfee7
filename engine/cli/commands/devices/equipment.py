"""`flexcell equipment`: serves the pins of a module's computer, and reads and replaces its configuration."""

from __future__ import annotations

import asyncio
import getpass
import socket
import sys
from collections.abc import Awaitable, Callable, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Annotated, Any, Protocol

import msgspec
import typer

from engine.cli.exit_code import ExitCode
from engine.cli.terminal.end_signals import end_at_signals
from engine.document.text.yaml_source import load_text
from engine.errors import FlexcellError
from engine.registry import SERVERS, load_factory

ServeEquipment = Callable[..., Awaitable[None]]
_TIMEOUT_S = 10.0


class ConfigurationClient(Protocol):
    """The part of a client of the equipment server that these commands use."""

    def configuration(self) -> Any:
        """Return the one in effect."""
        ...

    def template(self) -> Any:
        """Return a commented example."""
        ...

    def configure(self, text: str, *, base: str) -> str:
        """Replace the one with the digest `base`; return what was done."""
        ...

    def roll_back(self, *, base: str) -> str:
        """Take back the last change; return what was done."""
        ...

    def restart(self) -> str:
        """Have the file read anew; return what was done."""
        ...


Connect = Annotated[str, typer.Option(help="Address of the equipment server, HOST:PORT.", metavar="HOST:PORT")]
Base = Annotated[str, typer.Option(help="Digest of the configuration that is replaced, as `show` tells it.")]

app = typer.Typer(help="Serve outputs and inputs of a module's computer, and configure them.", no_args_is_help=True)


@app.command("serve")
def serve_equipment(
    file: Annotated[Path, typer.Argument(help="Equipment document, or a file of ReconCycle's raspi_ros.")],
    host: Annotated[str, typer.Option(help="Address to listen on; others than loopback reach the network.")] = (
        "127.0.0.1"
    ),
    port: Annotated[int, typer.Option(help="TCP port; 0 for a free one.", min=0, max=65535)] = 7391,
) -> None:
    """Serve the pins of a document until Ctrl-C; prints one JSON line with its address when it is ready.

    `flexcell equipment serve clamps.yaml --port 7391`

    Outputs are at their safe values at the start, at the end, and when the client that controls is silent or gone.
    """
    asyncio.run(_serve(file, host, port))
    raise typer.Exit(ExitCode.INTERRUPTED)


@app.command("show")
def show(connect: Connect) -> None:
    """Print the configuration in effect; its digest and the times of earlier ones go to standard error."""
    with _connected(connect) as client:
        read = client.configuration()
    sys.stdout.write(read.text)
    sys.stderr.write(f"digest {read.digest}\n" + "".join(f"kept {stamp}\n" for stamp in read.kept))


@app.command("template")
def template(connect: Connect) -> None:
    """Print a commented example for the hardware of the server."""
    with _connected(connect) as client:
        sys.stdout.write(client.template().text)


@app.command("set")
def set_configuration(
    file: Annotated[Path, typer.Argument(help="The new equipment document.")], connect: Connect, base: Base
) -> None:
    """Replace the configuration; outputs go to their safe values. Refused where another than BASE is in effect."""
    text = load_text(file).decode("utf-8", errors="replace")
    with _connected(connect) as client:
        sys.stdout.write(client.configure(text, base=base) + "\n")


@app.command("rollback")
def roll_back(connect: Connect, base: Base) -> None:
    """Put the configuration before the last change in effect again; outputs go to their safe values."""
    with _connected(connect) as client:
        sys.stdout.write(client.roll_back(base=base) + "\n")


@app.command("restart")
def restart(connect: Connect) -> None:
    """Have the server read its file anew; outputs go to their safe values."""
    with _connected(connect) as client:
        sys.stdout.write(client.restart() + "\n")


@app.command("guide")
def guide(connect: Connect) -> None:
    """Show a page in the terminal: the pins as they are, and the configuration to read, change, set and take back.

    `flexcell equipment guide --connect 192.168.1.40:7391`

    It needs `pip install 'flexcell[guide]'`.
    """
    host, port = _place(connect)
    show_guide: Callable[..., None] = load_factory(SERVERS, "equipment_guide")
    show_guide(host, port, name=_user(), timeout_s=_TIMEOUT_S)


@app.command("convert")
def convert(file: Annotated[Path, typer.Argument(help="File of ReconCycle's raspi_ros.")]) -> None:
    """Print a file of ReconCycle as an equipment document; Python objects in it are read and never made.

    `flexcell equipment convert active_config.yaml > clamps.yaml`
    """
    from engine.document.equipment.equipment_file import read_equipment
    from engine.document.equipment.reconcycle_file import document_text, plain_reconcycle

    text = load_text(file).decode("utf-8", errors="replace")
    equipment = read_equipment(plain_reconcycle(text, file=str(file)), file=file)
    sys.stdout.write(document_text(equipment.document))
    sys.stderr.write("check `safe` of each output: the file does not tell it, and `false` was written\n")


async def _serve(file: Path, host: str, port: int) -> None:
    ended = asyncio.Event()
    end_at_signals(ended.set)
    serve: ServeEquipment = load_factory(SERVERS, "equipment")
    await serve(file, host=host, port=port, ready=_ready, ended=ended)


def _ready(place: Mapping[str, object]) -> None:
    sys.stdout.write(msgspec.json.encode({"ready": place}).decode() + "\n")
    sys.stdout.flush()


def _connected(address: str) -> AbstractContextManager[ConfigurationClient]:
    host, port = _place(address)
    connected: Any = load_factory(SERVERS, "equipment_client")
    return connected(host, port, name=_user(), timeout_s=_TIMEOUT_S)


def _place(address: str) -> tuple[str, int]:
    host, colon, port = address.rpartition(":")
    if not colon or not port.isdecimal() or int(port) > 65535:
        raise FlexcellError(f"`{address}` is no address", where="--connect", hint="give HOST:PORT")
    return host, int(port)


def _user() -> str:
    return f"{getpass.getuser()} on {socket.gethostname()}"
