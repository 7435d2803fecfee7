"""`flexcell login`: creates a one-time login address of the running server for a browser."""

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
    viewer: Annotated[bool, typer.Option("--viewer", help="Create a read-only login.")] = False,
    state: Annotated[Path, typer.Option(help="Folder in which the server keeps its state.")] = Path(STATE_FOLDER),
    open_: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
) -> None:
    """Print an address that logs one browser in to the running server; valid once, within an hour."""
    url = new_login_url(ServerRecord.read(state), role="viewer" if viewer else "operator")
    typer.echo(url)
    if open_:
        webbrowser.open(url)


def new_login_url(record: ServerRecord, *, role: str) -> str:
    """Request a one-time login address from a running server.

    Raises:
        BusError: the server does not respond, or rejects the request.
    """
    headers = {"Authorization": f"Bearer {record.token}"}
    try:
        response = httpx.post(
            f"{record.url}api/v1/login-links",
            json={"role": role},
            headers=headers,
            timeout=_LIMIT_S,
            trust_env=False,
        )
    except httpx.TransportError as error:
        raise BusError(
            f"the server does not respond: {error}", where=record.url, hint="start it with `flexcell serve`"
        ) from error
    link = msgspec.json.decode(verify_response(response).content, type=_Link)
    return f"{record.url}login?t={link.token}"
