"""Reads changes committed by other programs on its own thread and delivers them on the event loop."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from threading import Event, Thread

from engine.errors import StoreError
from engine.store.contract import ChangeListener
from engine.store.row_mapping import change_of
from engine.store.rows import RevisionRow
from engine.store.table import ChangeSource

_RETRY_S = 1.0
"""Time to wait before a failed feed is read again."""

_log = logging.getLogger("flexcell.store")


class ChangeFeed:
    """Notifies listeners of the changes of a feed, except those committed by `writer`."""

    def __init__(self, feed: ChangeSource, *, writer: str, loop: asyncio.AbstractEventLoop) -> None:
        self._feed = feed
        self._writer = writer
        self._loop = loop
        self._listeners: dict[object, ChangeListener] = {}
        self._stop = Event()
        self._thread = Thread(target=self._run, name="store changes", daemon=True)

    def start(self) -> None:
        """Start reading changes."""
        self._thread.start()

    def subscribe(self, listener: ChangeListener) -> Callable[[], None]:
        """Call `listener` on the event loop for each change; returns a function that ends this."""
        token = object()
        self._listeners[token] = listener

        def unsubscribe() -> None:
            self._listeners.pop(token, None)

        return unsubscribe

    def stop(self) -> None:
        """End the thread and wait until it has closed the database; do not call it on the event loop."""
        self._stop.set()
        self._thread.join()

    def _run(self) -> None:
        failed = False
        while not self._stop.is_set():
            try:
                rows = self._feed.wait(self._stop)
                failed = False
            except StoreError as error:
                if not failed:
                    _log.warning("changes by other programs are not received for now: %s", error)
                failed = True
                self._stop.wait(_RETRY_S)
                continue
            others = tuple(row for row in rows if row.writer != self._writer)
            if others and not self._stop.is_set():
                self._loop.call_soon_threadsafe(self._notify, others)
        self._feed.close()

    def _notify(self, rows: tuple[RevisionRow, ...]) -> None:
        for row in rows:
            for listener in tuple(self._listeners.values()):
                listener(change_of(row))
