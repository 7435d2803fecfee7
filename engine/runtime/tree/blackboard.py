"""A blackboard of its own for one activation of a tree, though py_trees keeps one for the whole process.

py_trees' behaviours reach the blackboard through attributes of a class. While one of ours is in
use these attributes are its own, so two runs in one process never see each other's keys, and
nothing stays behind. What a behaviour does on the blackboard from a thread of its own, outside a
tick, reaches the common one.
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
    """Use it with `with` around everything in which behaviours of py_trees' kind run; never across an await."""

    def __init__(self) -> None:
        self._storage: dict[str, Any] = {}
        self._metadata: dict[str, KeyMetaData] = {}
        self._clients: dict[UUID, str] = {}
        self._stream: ActivityStream | None = None

    def __enter__(self) -> None:
        """Put it in the place of the common one."""
        _SWITCH.acquire()
        self._exchange()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Put the common one back."""
        self._exchange()
        _SWITCH.release()

    def _exchange(self) -> None:
        own = (self._storage, self._metadata, self._clients, self._stream)
        common = (Blackboard.storage, Blackboard.metadata, Blackboard.clients, Blackboard.activity_stream)
        Blackboard.storage, Blackboard.metadata, Blackboard.clients, Blackboard.activity_stream = own
        self._storage, self._metadata, self._clients, self._stream = common
