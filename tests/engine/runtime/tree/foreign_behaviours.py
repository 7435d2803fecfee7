"""Behaviours of py_trees' kind, as somebody else might have written them."""

from __future__ import annotations

from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Access, Status
from py_trees.composites import Sequence

CALLS: list[str] = []
"""What was called, as `name method`; a test that uses it clears it."""


class Scripted(Behaviour):
    """Be RUNNING for so many ticks, then end so; tell every call, and raise in one of them if told to."""

    def __init__(self, name: str, ticks: int = 1_000_000, status: Status = Status.SUCCESS, raises: str = "") -> None:
        super().__init__(name)
        self.ticks = ticks
        self.final = status
        self.raises = raises
        self.count = 0
        self.call("constructor")

    def call(self, method: str) -> None:
        CALLS.append(f"{self.name} {method}")
        if method == self.raises:
            raise ZeroDivisionError(f"in {method}")

    def setup(self, **kwargs: Any) -> None:
        self.call("setup")

    def initialise(self) -> None:
        self.count = 0
        self.call("initialise")

    def update(self) -> Status:
        self.count += 1
        self.call("update")
        return Status.RUNNING if self.count <= self.ticks else self.final

    def terminate(self, new_status: Status) -> None:
        self.call(f"terminate {new_status.value}")
        self.call("terminate") if self.raises == "terminate" else None

    def shutdown(self) -> None:
        self.call("shutdown")


class Counter(Behaviour):
    """Count on the blackboard, under an absolute key, up to what `limit` says."""

    def __init__(self, name: str, limit: int) -> None:
        super().__init__(name)
        self.limit = limit
        self.board = self.attach_blackboard_client(name, namespace="/shared")
        self.board.register_key("count", access=Access.WRITE)

    def update(self) -> Status:
        count = (self.board.get("count") if self.board.exists("count") else 0) + 1
        self.board.set("count", count)
        return Status.SUCCESS if count >= self.limit else Status.RUNNING


class Double(Behaviour):
    """Write twice what stands under `x` under `y`."""

    def __init__(self) -> None:
        super().__init__("double")
        self.board = self.attach_blackboard_client()
        self.board.register_key("x", access=Access.READ)
        self.board.register_key("y", access=Access.WRITE)

    def update(self) -> Status:
        self.board.set("y", 2 * self.board.get("x"))
        return Status.SUCCESS


class Pair(Sequence):
    """A composite that brings its own children."""

    def __init__(self, name: str) -> None:
        super().__init__(name, True, [Scripted("first", ticks=0), Scripted("second", ticks=1)])


class Lost(Behaviour):
    """Return something that is no status."""

    def update(self) -> Status:
        return None  # type: ignore[return-value]


class Abstract(Behaviour):
    """Lack an `update`."""
