"""Reads the changes committed to a MongoDB store: by a change stream, or by polling without a replica set."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from threading import Event
from typing import Any

import pymongo
from pymongo.change_stream import CollectionChangeStream
from pymongo.collection import Collection

from engine.store.mongo.mongo_documents import Document, row_from_document
from engine.store.mongo.mongo_errors import translate_mongo_errors
from engine.store.rows import RevisionRow

PERIOD_S = 0.3
OVERLAP = timedelta(seconds=60)
"""Tolerated clock difference of writers and delay of visible writes; changes within it are not missed."""
_TIMEOUT_S = 10.0


class MongoChangeStream:
    """The changes of a replica set in commit order, without a gap after a lost connection."""

    def __init__(self, changes: Collection[Document], *, address: str) -> None:
        self._changes = changes
        self._address = address
        with translate_mongo_errors("cannot be followed", address=address):
            self._stream: CollectionChangeStream[Document] | None = self._open(None)
        self._token: Any = None

    def wait(self, stop: Event) -> tuple[RevisionRow, ...]:
        """Return the next change, or none after one period."""
        with translate_mongo_errors("cannot be followed", address=self._address):
            if self._stream is None or not self._stream.alive:
                self._stream = self._open(self._token)
            with pymongo.timeout(_TIMEOUT_S):
                found = self._stream.try_next()
            self._token = self._stream.resume_token
        return () if found is None else (row_from_document(found["fullDocument"]),)

    def close(self) -> None:
        """Close the stream."""
        if self._stream is not None:
            self._stream.close()

    def _open(self, token: Any) -> CollectionChangeStream[Document]:
        return self._changes.watch(
            [{"$match": {"operationType": "insert"}}],
            resume_after=token,
            max_await_time_ms=int(PERIOD_S * 1000),
        )


class MongoChangePoller:
    """The changes of a server without change streams: the new ones among those of the last minute."""

    def __init__(self, changes: Collection[Document], *, address: str) -> None:
        self._changes = changes
        self._address = address
        self._known: dict[str, datetime] = {}
        with translate_mongo_errors("cannot be followed", address=address):
            self._latest = datetime.now(UTC)
            self._read()

    def wait(self, stop: Event) -> tuple[RevisionRow, ...]:
        """Return the changes since the last call."""
        if stop.wait(PERIOD_S):
            return ()
        with translate_mongo_errors("cannot be followed", address=self._address):
            return self._read()

    def close(self) -> None:
        """Do nothing: there is nothing open."""

    def _read(self) -> tuple[RevisionRow, ...]:
        with pymongo.timeout(_TIMEOUT_S):
            found = list(self._changes.find({"changed": {"$gte": self._latest - OVERLAP}}).sort("changed"))
        new = [document for document in found if document["_id"] not in self._known]
        self._known = {document["_id"]: document["changed"] for document in found}
        self._latest = max([self._latest, *self._known.values()])
        return tuple(row_from_document(document) for document in new)
