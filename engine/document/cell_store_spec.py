"""The store of a cell document: a file, or a MongoDB server."""

from __future__ import annotations

import re
from typing import Annotated

from msgspec import Meta

from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DocumentSource
from engine.errors import DocumentError

# A password between `:` and `@` that is not an environment variable.
_SECRET = re.compile(r"://[^@/:]*:(?!\$\{\w+\}@)[^@/]*@")


class SqliteStoreSpec(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="sqlite"):
    """Named entries in a file; `seed` is an entries document with initial values of missing entries."""

    path: Annotated[str, Meta(min_length=1, description="Database file, relative to the current directory")]
    seed: Annotated[str, Meta(min_length=1, description="Entries document, relative to this one")] | None = None


class MongoStoreSpec(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="mongodb"):
    """Named entries on a MongoDB server; `seed` is an entries document with initial values of missing entries.

    `${NAME}` in `uri` is replaced by an environment variable, for example the password.
    """

    uri: Annotated[
        str, Meta(pattern=r"^(mongodb(\+srv)?://|\$\{)", description="For example `mongodb://127.0.0.1:27017`")
    ]
    database: Annotated[str, Meta(pattern="^[A-Za-z0-9_-]{1,63}$", description="Database name on the server")] = (
        "flexcell"
    )
    seed: Annotated[str, Meta(min_length=1, description="Entries document, relative to this one")] | None = None


def require_no_secret(store: SqliteStoreSpec | MongoStoreSpec | None, source: DocumentSource) -> None:
    """Require that the document of a cell contains no password; raises DocumentError."""
    if isinstance(store, MongoStoreSpec) and _SECRET.search(store.uri):
        raise DocumentError(
            "the `uri` of the store contains a password",
            where=source.position(("store", "uri")),
            hint="write ${NAME} instead and set that environment variable: mongodb://user:${NAME}@host",
        )
