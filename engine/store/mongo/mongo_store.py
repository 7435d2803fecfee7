"""The store on a MongoDB server, shared by all its clients. Needs the package pymongo.

pymongo works on the store's thread, as SQLite does: in virtual time both work on the calling thread,
which the asynchronous client of pymongo, with its timers and tasks, does not support.
"""

from __future__ import annotations

from collections.abc import Mapping

from engine.store.entry_kinds import STANDARD_KINDS, EntryKind
from engine.store.mongo.mongo_server import connect
from engine.store.mongo.mongo_table import MongoTable
from engine.store.table_store import TableStore


class MongoStore(TableStore):
    """A `Store` on a server; open it with `MongoStore.open`, close it or use `async with`."""

    @classmethod
    def open(
        cls,
        uri: str,
        *,
        database: str = "flexcell",
        inline: bool = False,
        kinds: Mapping[str, EntryKind] = STANDARD_KINDS,
        patience_s: float = 10.0,
    ) -> MongoStore:
        """Connect to a server; blocks until it answers.

        Args:
            uri: `mongodb://HOST:PORT`; `${NAME}` in it is replaced by an environment variable.
            database: The database on it.
            inline: Work on the calling thread, so that a run in virtual time stays deterministic.
            kinds: The kinds of entries.
            patience_s: Time to wait for a server that does not answer before an operation fails.

        Raises:
            StoreError: the server cannot be reached, refuses the credentials or is too old.
        """
        server = connect(uri, database=database, patience_s=patience_s)
        table = MongoTable(server, patience_s=patience_s)
        try:
            table.prepare()
        except BaseException:
            # After any error the threads of the driver must end.
            table.close()
            raise
        return cls(table, inline=inline, kinds=kinds)
