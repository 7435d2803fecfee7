"""Reads the documents of any collection on a MongoDB server, such as those of `mongodb_store`."""

from __future__ import annotations

from typing import Any, cast

from engine.errors import StoreError
from engine.store.mongo.mongo_errors import translate_mongo_errors
from engine.store.mongo.mongo_server import connect
from engine.store.ros.ros_import import MAX_DOCUMENTS, plain_bson
from engine.store.store_factory import split_database

DATABASE = "message_store"
"""The default database of `mongodb_store`."""


def read_collection(uri: str, *, collection: str, patience_s: float = 10.0) -> tuple[dict[str, Any], ...]:
    """Return the documents of a collection in the order of their insertion, as plain objects.

    Raises:
        StoreError: the server cannot be reached, refuses to be read, or has too many documents.
    """
    address, database = split_database(uri)
    server = connect(address, database=database or DATABASE, patience_s=patience_s, oldest=(4, 2))
    try:
        with translate_mongo_errors("cannot be read", address=server.address, user=server.user):
            cursor = server.database[collection].find().sort("_id").limit(MAX_DOCUMENTS + 1)
            documents = tuple(cast("dict[str, Any]", plain_bson(document)) for document in cursor)
        if len(documents) > MAX_DOCUMENTS:
            raise ValueError(f"there are more than {MAX_DOCUMENTS} documents")
    except (ValueError, TypeError, OverflowError, RecursionError) as error:
        raise StoreError(
            f"its documents cannot be read: {error}", where=server.address, hint="export the required documents only"
        ) from error
    else:
        return documents
    finally:
        server.client.close()
