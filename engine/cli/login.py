"""`flexcell login`: an address that logs a browser in at the running server, once."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated

import httpx
import msgspec
import typer

from engine.bus.remote_bus import ServerRecord, verify_response
from engine.errors import BusError
from engine.host.state_folder_names import STATE_FOLDER

_LIMIT_S = 10.0


class _Link(msgspec.Struct):
    token: str


def login(
    viewer: Annotated[bool, typer.Option("--viewer", help="For somebody who may look and change nothing.")] = False,
    state: Annotated[Path, typer.Option(help="State folder of the running server.")] = Path(STATE_FOLDER),
    open_: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
) -> None:
    """Print an address that logs one browser in at the running server; it works once, within an hour."""
    url = new_login_url(ServerRecord.read(state), role="viewer" if viewer else "operator")
    typer.echo(url)
    if open_:
        webbrowser.open(url)


def new_login_url(record: ServerRecord, *, role: str) -> str:
    """Ask a running server for an address that logs a browser in, once.

    Raises:
        BusError: the server does not answer, or refuses.
    """
    headers = {"Authorization": f"Bearer {record.token}"}
    try:
        answer = httpx.post(
            f"{record.url}api/v1/login-links",
            json={"role": role},
            headers=headers,
            timeout=_LIMIT_S,
            trust_env=False,
        )
    except httpx.TransportError as error:
        raise BusError(
            f"the server does not answer: {error}", where=record.url, hint="start it with `flexcell serve`"
        ) from error
    link = msgspec.json.decode(verify_response(answer).content, type=_Link)
    return f"{record.url}login?t={link.token}"
