"""A connection to a MongoDB server that is there, new enough, and lets us in."""

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
"""From here fields may have any name."""
DURABLE = WriteConcern("majority", j=True)
"""A write is reported only when most servers have it on their disks; the defaults of a server may lose it."""


@dataclass(frozen=True, kw_only=True)
class MongoServer:
    """An open connection; `replicated` servers have transactions and tell of changes."""

    client: MongoClient[Document]
    database: Database[Document]
    address: str
    user: str
    replicated: bool


def connect(uri: str, *, database: str, patience_s: float, oldest: tuple[int, int] = OLDEST_VERSION) -> MongoServer:
    """Connect to a server.

    Args:
        uri: Its address, `${NAME}` standing for environment variables.
        database: The database to use.
        patience_s: How long to look for the server.
        oldest: The least version of MongoDB that will do.

    Raises:
        StoreError: it cannot be reached, does not let us in, or is too old.
    """
    full = with_environment(uri)
    address, user = public_address(full, database), user_of(full)
    with translate_mongo_errors("cannot be opened", address=address, user=user):
        client: MongoClient[Document] = _client(full, address, patience_s)
        try:
            # Within a time limit the driver would try until that is over, whatever the address says.
            hello: dict[str, Any] = client.admin.command("hello")
            with pymongo.timeout(patience_s):
                verify_version(client.server_info()["versionArray"], address=address, oldest=oldest)
                chosen = client.get_database(
                    database, codec_options=OPTIONS, write_concern=DURABLE, read_preference=ReadPreference.PRIMARY
                )
                # Whoever may not read is told so now.
                chosen["entry"].find_one({}, {"_id": 1})
        except BaseException:
            # However it failed, the threads of the driver must end.
            client.close()
            raise
    replicated = "setName" in hello or hello.get("msg") == "isdbgrid"
    return MongoServer(client=client, database=chosen, address=address, user=user, replicated=replicated)


def verify_version(version: Sequence[int], *, address: str, oldest: tuple[int, int] = OLDEST_VERSION) -> None:
    """Refuse a server that is too old; raises StoreError."""
    if tuple(version[:2]) < oldest:
        found, needed = (".".join(map(str, numbers)) for numbers in (version[:3], oldest))
        raise StoreError(
            f"the store cannot be opened: the server is MongoDB {found}, too old",
            where=address,
            hint=f"use MongoDB {needed} or newer",
        )


def _client(uri: str, address: str, patience_s: float) -> MongoClient[Document]:
    # What the address says counts.
    own: dict[str, Any] = {"appname": "flexcell"}
    if "serverselectiontimeoutms" not in uri.lower():
        own["serverSelectionTimeoutMS"] = int(patience_s * 1000)
    try:
        return MongoClient(uri, **own)
    except PyMongoError:
        raise
    except (ValueError, TypeError) as error:
        raise StoreError(f"the address cannot be understood: {error}", where=address) from error
