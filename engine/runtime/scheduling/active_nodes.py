"""What is active in a run right now: nodes with their visits, and the task that carries each branch."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any, TypeVar

from engine.preemption import is_preempted
from engine.runtime.scheduling.eager_start import start_eagerly

T = TypeVar("T")


class ActiveNodes:
    """Belongs to one run, used on the loop thread."""

    def __init__(self) -> None:
        self.nodes: dict[str, int] = {}
        """Visit of each node that was entered and not yet left, by path."""
        self.branches: dict[str, asyncio.Task[Any]] = {}
        """The task that carries the node at a path; what carries only what is inside stands under `path/`."""

    def branch(self, path: str, work: Coroutine[Any, Any, T], *, body: bool = False) -> asyncio.Task[T]:
        """Start a task that carries the node at `path`, or with `body` only what is inside it, which begins at once."""
        key = f"{path}/" if body else path
        task = asyncio.create_task(work, name=path)
        self.branches[key] = task
        task.add_done_callback(lambda done: self.leave(key, done))
        if body:
            start_eagerly(task)
        return task

    def task_of(self, path: str) -> asyncio.Task[Any] | None:
        """Return the task in which the node at `path` is performed: that of its innermost branch."""
        found: str | None = None
        for key in self.branches:
            within = path == key or path.startswith(key if key.endswith("/") else f"{key}/")
            if within and (found is None or len(key) > len(found)):
                found = key
        return self.branches[found] if found is not None else None

    def is_preempted(self, path: str) -> bool:
        """Tell whether the task in which the node at `path` is performed has been asked to end."""
        # A state with a time-out is performed in one task, and runs in that of what is inside it.
        tasks = (self.branches.get(f"{path}/"), self.task_of(path))
        return any(task is not None and is_preempted(task) for task in tasks)

    def branch_of(self, path: str) -> str:
        """Return the path of that branch, empty for the whole run."""
        task = self.task_of(path)
        return task.get_name() if task is not None else ""

    def leave(self, path: str, task: asyncio.Task[Any]) -> None:
        """Take note that it does no more, unless another does by now."""
        if self.branches.get(path) is task:
            del self.branches[path]
