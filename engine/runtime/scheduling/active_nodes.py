"""Active nodes of a run with their visits, and the task that executes each branch."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any, TypeVar

from engine.preemption import is_preempted
from engine.runtime.scheduling.eager_start import start_eagerly

T = TypeVar("T")


class ActiveNodes:
    """Active nodes and branch tasks of one run; used on the loop thread."""

    def __init__(self) -> None:
        self.nodes: dict[str, int] = {}
        """Visit of each node that was entered and has not exited, by path."""
        self.branches: dict[str, asyncio.Task[Any]] = {}
        """The task that executes the node at a path; the task of its body alone is under `path/`."""

    def branch(self, path: str, work: Coroutine[Any, Any, T], *, body: bool = False) -> asyncio.Task[T]:
        """Start a task for the node at `path`, or with `body` for its body alone, which begins at once."""
        key = f"{path}/" if body else path
        task = asyncio.create_task(work, name=path)
        self.branches[key] = task
        task.add_done_callback(lambda done: self.leave(key, done))
        if body:
            start_eagerly(task)
        return task

    def task_of(self, path: str) -> asyncio.Task[Any] | None:
        """Return the task in which the node at `path` is performed: that of its innermost branch."""
        innermost: str | None = None
        for key in self.branches:
            within = path == key or path.startswith(key if key.endswith("/") else f"{key}/")
            if within and (innermost is None or len(key) > len(innermost)):
                innermost = key
        return self.branches[innermost] if innermost is not None else None

    def is_preempted(self, path: str) -> bool:
        """Return whether the task in which the node at `path` is performed is preempted."""
        # A state with a timeout is performed in one task and runs in the task of its body.
        tasks = (self.branches.get(f"{path}/"), self.task_of(path))
        return any(task is not None and is_preempted(task) for task in tasks)

    def branch_of(self, path: str) -> str:
        """Return the path of the innermost branch of a node; empty for the whole run."""
        task = self.task_of(path)
        return task.get_name() if task is not None else ""

    def leave(self, path: str, task: asyncio.Task[Any]) -> None:
        """Remove the task of a path, unless another task has replaced it."""
        if self.branches.get(path) is task:
            del self.branches[path]
