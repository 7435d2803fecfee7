"""Notifies pages of documents and of modules of states that change on disk, through another page, an editor or git."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Collection

from engine.editing import DocumentRepository

PERIOD_S = 1.0
_log = logging.getLogger("flexcell.documents")
DocumentsCallback = Callable[[dict[str, str | None]], None]


class DocumentWatch:
    """Polls the files of a project every second while a page is connected.

    Args:
        documents: The documents.
        changed: Called with the hash of each changed document, by id; None for a deleted one.
        reloaded: Called after modules of the project's own states were loaded anew, or could not be.
        are_used: Returns whether a run executes classes of these modules; they are then loaded later.
        is_needed: Returns whether a page is connected.
        period_s: Polling period.
    """

    def __init__(
        self,
        documents: DocumentRepository,
        *,
        changed: DocumentsCallback,
        is_needed: Callable[[], bool],
        reloaded: Callable[[], None] = lambda: None,
        are_used: Callable[[Collection[str]], bool] = lambda _: False,
        period_s: float = PERIOD_S,
    ) -> None:
        self._documents = documents
        self._changed = changed
        self._is_needed = is_needed
        self._reloaded = reloaded
        self._are_used = are_used
        self._period_s = period_s
        self._seen: dict[str, tuple[int, int]] | None = None
        self._task: asyncio.Task[None] | None = None

    def open(self) -> None:
        """Start polling: later changes are reported, those before the first page too.

        What a page loads may be older than the first scan after it has connected, so scans compare with the last one,
        however long ago that was.
        """
        try:
            self._seen = self._documents.stamps()
        except OSError as error:
            _log.info("could not scan the documents: %s", error)
        self._task = asyncio.create_task(self._poll_documents(), name="document-watch")

    async def close(self) -> None:
        """Stop polling."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})
            self._task = None

    def look(self) -> dict[str, str | None]:
        """Return the changes since the last call; nothing at the first call. May be called from any thread."""
        before, now = self._seen, self._documents.stamps()
        self._seen = now
        if before is None:
            return {}
        changed = [each for each in {**before, **now} if before.get(each) != now.get(each)]
        return {each: self._documents.hash_on_disk(each) for each in changed}

    async def _poll_documents(self) -> None:
        while True:
            # Not every file system reports changes, in particular those shared between containers.
            await asyncio.sleep(self._period_s)
            if not self._is_needed():
                continue
            try:
                changed = await asyncio.to_thread(self.look)
            except OSError as error:
                # A folder was removed during the scan; the next scan reports the result.
                _log.info("could not scan the documents: %s", error)
                continue
            if changed:
                self._changed(changed)
            await self._reload_states()

    async def _reload_states(self) -> None:
        states = self._documents.states
        # A run keeps the classes that it began with; what it imports later must be of the same modules.
        if not await asyncio.to_thread(states.is_due) or self._are_used(states.modules):
            return
        if await asyncio.to_thread(self._documents.reload_states):
            self._reloaded()
