"""A separate blackboard for each activation of a tree, in place of the process-wide blackboard of py_trees.

py_trees behaviours access the blackboard through class attributes. While an isolated blackboard is in use, these
attributes are its own, so two runs in one process never see each other's keys, and no keys remain. Accesses from a
thread of a behaviour, outside a tick, reach the process-wide blackboard.
"""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Any
from uuid import UUID

from py_trees.blackboard import ActivityStream, Blackboard, KeyMetaData

# Another engine may tick on another thread's event loop; a tick never waits while it holds this.
_SWITCH = threading.RLock()


class IsolatedBlackboard:
    """Context manager for all code that runs py_trees behaviours; never hold it across an await."""

    def __init__(self) -> None:
        self._storage: dict[str, Any] = {}
        self._metadata: dict[str, KeyMetaData] = {}
        self._clients: dict[UUID, str] = {}
        self._stream: ActivityStream | None = None

    def __enter__(self) -> None:
        """Replace the process-wide blackboard."""
        _SWITCH.acquire()
        self._exchange()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Restore the process-wide blackboard."""
        self._exchange()
        _SWITCH.release()

    def _exchange(self) -> None:
        own = (self._storage, self._metadata, self._clients, self._stream)
        shared = (Blackboard.storage, Blackboard.metadata, Blackboard.clients, Blackboard.activity_stream)
        Blackboard.storage, Blackboard.metadata, Blackboard.clients, Blackboard.activity_stream = own
        self._storage, self._metadata, self._clients, self._stream = shared
