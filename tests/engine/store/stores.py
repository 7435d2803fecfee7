"""Every kind of store that the contract is tested on, opened by the folder that a test owns."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pymongo
import pytest

from engine.store import SqliteStore, Store
from engine.store.mongo.mongo_store import MongoStore
from tests.engine.store.mongod import Mongod

Opener = Callable[[Path], Store]
KINDS = ("sqlite inline", "sqlite threaded", "mongodb replicated", "mongodb standalone")
DURABLE_KINDS = ("sqlite threaded", "mongodb replicated", "mongodb standalone")


def opener_of(kind: str, request: pytest.FixtureRequest) -> Opener:
    """Return what opens a store of a kind; the same folder always means the same entries."""
    engine, _, mode = kind.partition(" ")
    inline = mode.endswith("inline")
    if engine == "sqlite":
        return lambda place: SqliteStore.open(place / "store.db", inline=inline)
    server: Mongod = request.getfixturevalue(f"{mode.split()[0]}_mongo")
    opened: set[str] = set()

    def drop() -> None:
        client: pymongo.MongoClient[dict[str, Any]] = pymongo.MongoClient(server.uri)
        with client:
            for database in opened:
                client.drop_database(database)

    request.addfinalizer(drop)

    def open_mongo(place: Path) -> Store:
        opened.add(database_of(place))
        return MongoStore.open(server.uri, database=database_of(place), inline=inline, patience_s=60.0)

    return open_mongo


def database_of(place: Path) -> str:
    """Return the name of the database that belongs to a folder."""
    return f"t{hashlib.sha256(str(place).encode()).hexdigest()[:20]}"
