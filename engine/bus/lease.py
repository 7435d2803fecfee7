"""Leases of resources: one run at a time, and within it one branch at a time, commands a resource.

A resource is a bus name such as `left` or `left/gripper`. A run that commands any part of
`left` owns all of `left` until the run ends; inside the run a branch leases exactly the resources
it names while its state is active.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable

import msgspec

from engine.errors import LeaseRefused


class Holder(msgspec.Struct, frozen=True):
    """The holder of a resource: a run (or `cli`, `jog`, …) and its branch, a node path."""

    run: str
    branch: str = ""

    def __str__(self) -> str:
        return f"run {self.run} at {self.branch}" if self.branch else f"run {self.run}"


class Lease(msgspec.Struct, frozen=True, kw_only=True):
    """The lease of `resource` since `since_s` of the bus's clock; `branch` is empty when only the run owns it."""

    resource: str
    run: str
    branch: str
    since_s: float


class LeaseTable:
    """All leases of one bus; used on the loop thread only.

    Args:
        now_s: The clock for the start times of leases.
    """

    def __init__(self, *, now_s: Callable[[], float] = lambda: 0.0) -> None:
        self._now_s = now_s
        self._owners: dict[str, str] = {}
        self._owned_since_s: dict[str, float] = {}
        self._leased_since_s: dict[str, float] = {}
        self._branches: dict[str, list[Holder]] = {}
        self._waiting: list[tuple[str, Callable[[], None]]] = []
        self._ends: dict[str, Callable[[str], Awaitable[None]]] = {}

    def acquire(self, resources: Iterable[str], holder: Holder) -> None:
        """Lease all of `resources` or none; nested leases of the same branch are counted.

        Raises:
            LeaseRefused: another holder has one of them; the message names it.
        """
        requested = tuple(resources)
        for resource in requested:
            self.refuse_foreign(resource, holder)
        for resource in requested:
            root = _root(resource)
            if root not in self._owners:
                self._owned_since_s[root] = self._now_s()
            if resource not in self._branches:
                self._leased_since_s[resource] = self._now_s()
            self._owners[root] = holder.run
            self._branches.setdefault(resource, []).append(holder)

    def release(self, resources: Iterable[str], holder: Holder) -> None:
        """Release branch leases; the run owns the resource until `release_run`."""
        for resource in resources:
            held = self._branches.get(resource, [])
            if holder in held:
                held.remove(holder)
            if not held:
                self._branches.pop(resource, None)
                self._leased_since_s.pop(resource, None)

    def on_claim(self, run: str, end: Callable[[str], Awaitable[None]]) -> None:
        """Call `end` with the reason when somebody claims a resource of `run`; it returns when the run has ended."""
        self._ends[run] = end

    async def claim(self, resource: str, holder: Holder, *, reason: str) -> None:
        """End the run that owns a resource, and wait for its end; who owns it otherwise, keeps it."""
        owner = self.owner(resource)
        if owner is not None and owner != holder.run and owner in self._ends:
            await self._ends[owner](reason)

    def release_run(self, run: str) -> None:
        """Release all resources of a run."""
        self._ends.pop(run, None)
        self._owners = {name: owner for name, owner in self._owners.items() if owner != run}
        kept = {name: [h for h in held if h.run != run] for name, held in self._branches.items()}
        self._branches = {name: held for name, held in kept.items() if held}
        self._owned_since_s = {name: at_s for name, at_s in self._owned_since_s.items() if name in self._owners}
        self._leased_since_s = {name: at_s for name, at_s in self._leased_since_s.items() if name in self._branches}
        freed = [(name, callback) for name, callback in self._waiting if name not in self._owners]
        self._waiting = [entry for entry in self._waiting if entry not in freed]
        for _, callback in freed:
            callback()

    def when_freed(self, resource: str, callback: Callable[[], None]) -> None:
        """Call `callback` once when the run that owns the resource releases it; never when no run owns it."""
        if _root(resource) in self._owners:
            self._waiting.append((_root(resource), callback))

    def owner(self, resource: str) -> str | None:
        """Return the run that owns a resource, if any."""
        return self._owners.get(_root(resource))

    def listing(self) -> tuple[tuple[str, str], ...]:
        """Return (resource, holder) of every lease, sorted."""
        rows = {name: f"run {owner}" for name, owner in self._owners.items()}
        rows.update({name: str(held[-1]) for name, held in self._branches.items()})
        return tuple(sorted(rows.items()))

    def held(self) -> tuple[Lease, ...]:
        """Return every lease with its holder, sorted by resource."""
        rows = {
            name: Lease(resource=name, run=owner, branch="", since_s=self._owned_since_s[name])
            for name, owner in self._owners.items()
        }
        for name, held in self._branches.items():
            run, branch = held[-1].run, held[-1].branch
            rows[name] = Lease(resource=name, run=run, branch=branch, since_s=self._leased_since_s[name])
        return tuple(rows[name] for name in sorted(rows))

    def refuse_foreign(self, resource: str, holder: Holder) -> None:
        """Raise LeaseRefused when another holder commands the resource; leases nothing."""
        owner = self._owners.get(_root(resource))
        if owner is not None and owner != holder.run:
            raise LeaseRefused(
                f"{resource} is commanded by {self._describe(resource, owner)}",
                where=str(holder),
                hint=f"wait for run {owner} to end or stop it",
            )
        for other in self._branches.get(resource, ()):
            if other.branch != holder.branch:
                raise LeaseRefused(
                    f"{resource} is commanded by {other} in another branch",
                    where=str(holder),
                    hint="command it from one branch at a time",
                )

    def _describe(self, resource: str, owner: str) -> str:
        for name, held in self._branches.items():
            if _root(name) == _root(resource) and held:
                return str(held[-1])
        return f"run {owner}"


def _root(resource: str) -> str:
    return resource.partition("/")[0]
