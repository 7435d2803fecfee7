"""Loads what the first plans need in a worker thread while the arm is already served; plans that need it wait."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

from engine.errors import RobotError

LOADING_LIMIT_S = 300.0
"""As long as a start of the planning process: the first one on a machine compiles all kernels."""
_log = logging.getLogger("flexcell.arm")


class WarmUp:
    """Calls `load` once in a worker thread, started by `begin`.

    Without `begin` nothing is preloaded and nobody waits. A failure is logged; the plan that needs the missing
    modules fails with the reason.
    """

    def __init__(self, name: str, load: Callable[[], None]) -> None:
        self._name = name
        self._load = load
        self._task: asyncio.Task[None] | None = None

    @property
    def active(self) -> bool:
        """True from `begin` until loading has finished."""
        return self._task is not None and not self._task.done()

    def begin(self) -> None:
        """Start loading."""
        if self._task is None:
            self._task = asyncio.create_task(self._run(), name=f"loading for {self._name}")

    async def finished(self) -> None:
        """Return when loading has finished; cancelling a caller does not cancel the loading.

        Raises:
            RobotError: it takes longer than `LOADING_LIMIT_S` from now on; it goes on.
        """
        if self._task is None:
            return
        if not await self._ends():
            raise RobotError(
                f"inverse kinematics was not loaded within {LOADING_LIMIT_S:g} s",
                where=self._name,
                hint="try again when the computer has less to do: the first load on a machine compiles it",
            )

    async def close(self) -> None:
        """Return when loading has finished; a thread that does not end in time is left behind."""
        if self._task is None or await self._ends():
            return
        _log.error("%s: closed before inverse kinematics was loaded", self._name)
        self._task.cancel()
        await asyncio.wait((self._task,))

    async def _ends(self) -> bool:
        assert self._task is not None
        done, _ = await asyncio.wait((self._task,), timeout=LOADING_LIMIT_S)
        return bool(done)

    async def _run(self) -> None:
        try:
            await asyncio.to_thread(self._load)
        except Exception:
            # No caller is waiting yet; the first plan tries again and reports the error to its caller.
            _log.exception("%s: inverse kinematics cannot be loaded", self._name)
