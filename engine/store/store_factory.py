"""Opens a store by its address: the path of a file, or `mongodb://HOST:PORT/DATABASE`."""

from __future__ import annotations

import asyncio
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit, urlunsplit

from engine.errors import StoreError
from engine.store.contract import Store
from engine.store.mongo.mongo_address import is_mongo_address
from engine.store.sqlite.sqlite_store import SqliteStore

DATABASE = "flexcell"
"""The database on a server where none is named."""


async def open_store(
    address: str | Path, *, database: str | None = None, inline: bool = False, patience_s: float = 10.0
) -> Store:
    """Open the store at an address.

    Args:
        address: A path, or the address of a MongoDB server; `${NAME}` in it stands for an environment variable.
        database: The database on a server; by default the one in the address, else `flexcell`.
        inline: Work on the calling thread, for runs in virtual time.
        patience_s: How long to wait for a server that does not answer.

    Raises:
        StoreError: it cannot be opened, or needs a package that is not installed.
    """
    if not is_mongo_address(str(address)):
        return SqliteStore.open(address, inline=inline)
    mongo = _mongo(str(address))
    uri, named = (str(address), database) if database is not None else split_database(str(address))

    def connect() -> Store:
        return mongo.MongoStore.open(uri, database=named or DATABASE, inline=inline, patience_s=patience_s)

    # Looking for a server may take seconds, during which the event loop has better things to do.
    return connect() if inline else await asyncio.to_thread(connect)


def _mongo(address: str) -> Any:
    try:
        return import_module("engine.store.mongo.mongo_store")
    except ImportError as error:
        raise StoreError(
            f"a store on MongoDB needs the package pymongo: {error}",
            where="store",
            hint="pip install 'flexcell[mongo]'",
        ) from error


def split_database(uri: str) -> tuple[str, str]:
    """Return an address without the database in it, and the database."""
    parts = urlsplit(uri)
    database = parts.path.strip("/")
    if not database:
        return uri, ""
    query = parts.query
    # Logging in is against the database in the address, unless the options say otherwise.
    if "@" in parts.netloc and "authSource" not in query:
        query = f"{query}&authSource={database}" if query else f"authSource={database}"
    return urlunsplit((parts.scheme, parts.netloc, "/", query, "")), database
