"""What the first plans need, loaded in a worker thread while the arm already answers; plans that need it wait."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

_log = logging.getLogger("flexcell.arm")


class WarmUp:
    """One call of `load`, in a worker thread, from `begin` on.

    Without `begin` nothing is loaded beforehand, and nobody waits. A failure is written to the log; the
    plan that needs what is missing fails with the reason.
    """

    def __init__(self, name: str, load: Callable[[], None]) -> None:
        self._name = name
        self._load = load
        self._task: asyncio.Task[None] | None = None

    @property
    def under_way(self) -> bool:
        """True from `begin` until it is loaded."""
        return self._task is not None and not self._task.done()

    def begin(self) -> None:
        """Start loading."""
        if self._task is None:
            self._task = asyncio.create_task(self._run(), name=f"loading for {self._name}")

    async def finished(self) -> None:
        """Return when nothing is being loaded; a caller that is cancelled leaves the loading alone."""
        if self._task is not None:
            await asyncio.wait((self._task,))

    async def _run(self) -> None:
        try:
            await asyncio.to_thread(self._load)
        except Exception:
            # Nobody has asked yet; the first plan tries again and tells who asked.
            _log.exception("%s: inverse kinematics cannot be loaded", self._name)
