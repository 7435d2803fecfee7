"""Connects to a MongoDB server and verifies its version and the credentials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import pymongo
from pymongo import MongoClient
from pymongo.database import Database
from pymongo.errors import PyMongoError
from pymongo.read_preferences import ReadPreference
from pymongo.write_concern import WriteConcern

from engine.errors import StoreError
from engine.store.mongo.mongo_address import public_address, user_of, with_environment
from engine.store.mongo.mongo_documents import OPTIONS, Document
from engine.store.mongo.mongo_errors import translate_mongo_errors

OLDEST_VERSION = (5, 0)
"""Oldest supported version, the first that accepts any field name."""
DURABLE = WriteConcern("majority", j=True)
"""A write is acknowledged when a majority of servers has it on disk; the defaults of a server may lose it."""


@dataclass(frozen=True, kw_only=True)
class MongoServer:
    """An open connection; `replicated` servers have transactions and change streams."""

    client: MongoClient[Document]
    database: Database[Document]
    address: str
    user: str
    replicated: bool


def connect(uri: str, *, database: str, patience_s: float, oldest: tuple[int, int] = OLDEST_VERSION) -> MongoServer:
    """Connect to a server.

    Args:
        uri: The address; `${NAME}` is replaced by an environment variable.
        database: The database to use.
        patience_s: Time to wait for the server.
        oldest: The minimum version of MongoDB.

    Raises:
        StoreError: the server cannot be reached, refuses the credentials, or is too old.
    """
    full = with_environment(uri)
    address, user = public_address(full, database), user_of(full)
    with translate_mongo_errors("cannot be opened", address=address, user=user):
        client: MongoClient[Document] = _client(full, address, patience_s)
        try:
            # Outside the time limit below: within it the driver would ignore the timeouts of the address.
            hello: dict[str, Any] = client.admin.command("hello")
            with pymongo.timeout(patience_s):
                verify_version(client.server_info()["versionArray"], address=address, oldest=oldest)
                chosen = client.get_database(
                    database, codec_options=OPTIONS, write_concern=DURABLE, read_preference=ReadPreference.PRIMARY
                )
                # Missing read permission is reported here.
                chosen["entry"].find_one({}, {"_id": 1})
        except BaseException:
            # After any error the threads of the driver must end.
            client.close()
            raise
    replicated = "setName" in hello or hello.get("msg") == "isdbgrid"
    return MongoServer(client=client, database=chosen, address=address, user=user, replicated=replicated)


def verify_version(version: Sequence[int], *, address: str, oldest: tuple[int, int] = OLDEST_VERSION) -> None:
    """Refuse a server that is too old; raises StoreError."""
    if tuple(version[:2]) < oldest:
        actual, needed = (".".join(map(str, numbers)) for numbers in (version[:3], oldest))
        raise StoreError(
            f"the store cannot be opened: the server is MongoDB {actual}, too old",
            where=address,
            hint=f"use MongoDB {needed} or newer",
        )


def _client(uri: str, address: str, patience_s: float) -> MongoClient[Document]:
    # Options in the address take precedence.
    own: dict[str, Any] = {"appname": "flexcell"}
    if "serverselectiontimeoutms" not in uri.lower():
        own["serverSelectionTimeoutMS"] = int(patience_s * 1000)
    try:
        return MongoClient(uri, **own)
    except PyMongoError:
        raise
    except (ValueError, TypeError) as error:
        raise StoreError(f"the address is invalid: {error}", where=address) from error
