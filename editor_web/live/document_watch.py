"""Tells pages when a document changes on disk, by whoever: another page, an editor, git."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

from engine.editing import DocumentRepository

PERIOD_S = 1.0
_log = logging.getLogger("flexcell.documents")
DocumentsCallback = Callable[[dict[str, str | None]], None]


class DocumentWatch:
    """Looks at the files of a project each second while somebody is there to be told.

    Args:
        documents: The documents.
        changed: Called with the hash of each document that has changed, by id; None where it is gone.
        wanted: Whether anybody wants to know.
        period_s: Time between looks.
    """

    def __init__(
        self,
        documents: DocumentRepository,
        *,
        changed: DocumentsCallback,
        wanted: Callable[[], bool],
        period_s: float = PERIOD_S,
    ) -> None:
        self._documents = documents
        self._changed = changed
        self._wanted = wanted
        self._period_s = period_s
        self._seen: dict[str, tuple[int, int]] | None = None
        self._task: asyncio.Task[None] | None = None

    def open(self) -> None:
        """Begin to look."""
        self._task = asyncio.create_task(self._poll_documents(), name="document-watch")

    async def close(self) -> None:
        """Look no more."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})
            self._task = None

    def look(self) -> dict[str, str | None]:
        """Return what has changed since the last look; nothing at the first. May be called from any thread."""
        before, now = self._seen, self._documents.stamps()
        self._seen = now
        if before is None:
            return {}
        touched = [each for each in {**before, **now} if before.get(each) != now.get(each)]
        return {each: self._documents.hash_on_disk(each) for each in touched}

    async def _poll_documents(self) -> None:
        while True:
            # Not every file system tells of changes, least of all those that containers share.
            await asyncio.sleep(self._period_s)
            if not self._wanted():
                self._seen = None
                continue
            try:
                found = await asyncio.to_thread(self.look)
            except OSError as error:
                # A folder that goes while it is looked through; the next look sees what has become of it.
                _log.info("could not scan the documents: %s", error)
                continue
            if found:
                self._changed(found)
