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
"""The default database on a server."""


async def open_store(
    address: str | Path, *, database: str | None = None, inline: bool = False, patience_s: float = 10.0
) -> Store:
    """Open the store at an address.

    Args:
        address: A path, or the address of a MongoDB server; `${NAME}` in it is replaced by an environment variable.
        database: The database on a server; by default the one in the address, else `flexcell`.
        inline: Work on the calling thread, for runs in virtual time.
        patience_s: Time to wait for a server that does not answer.

    Raises:
        StoreError: the store cannot be opened, or needs a package that is not installed.
    """
    if not is_mongo_address(str(address)):
        return SqliteStore.open(address, inline=inline)
    mongo = _mongo()
    uri, named = (str(address), database) if database is not None else split_database(str(address))

    def connect() -> Store:
        return mongo.MongoStore.open(uri, database=named or DATABASE, inline=inline, patience_s=patience_s)

    # Connecting to a server may take seconds and must not block the event loop.
    return connect() if inline else await asyncio.to_thread(connect)


def _mongo() -> Any:
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
    # The database in the address is the authentication database, unless the options name another one.
    if "@" in parts.netloc and "authSource" not in query:
        query = f"{query}&authSource={database}" if query else f"authSource={database}"
    return urlunsplit((parts.scheme, parts.netloc, "/", query, "")), database
