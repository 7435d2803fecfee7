"""One fault of a run: the requests to which it applies, and how often it was applied."""

from __future__ import annotations

import random

from engine.document.faults import ErrorFault, Fault
from engine.document.path_pattern import compile_pattern
from engine.errors import Position


class FaultRule:
    """A fault with its counters in one run.

    Whether it is applied depends on the seed, the state and the number of the request of that
    state, never on other branches; only `times` counts over all branches.
    """

    def __init__(self, fault: Fault, *, number: int, seed: int, position: Position) -> None:
        self.fault = fault
        self.number = number
        self.position = position
        self.applied = 0
        self._seed = seed
        self._path = compile_pattern(fault.at)
        self._address = compile_pattern(fault.address)
        self._requests: dict[str, int] = {}
        self._matched = 0
        self._in_turn = 0

    @property
    def label(self) -> str:
        """Its label in events and messages: its name, else its number in the document."""
        return self.fault.name or f"fault {self.number}"

    @property
    def failure(self) -> ErrorFault:
        """The failure of a fault of kind `error`."""
        failure = self.fault.failure
        if failure is None:
            raise ValueError(f"{self.label} is not of kind error")
        return failure

    @property
    def ignores_cancel(self) -> bool:
        """Whether a hanging goal also ignores cancel requests."""
        return self.fault.hang is not None and self.fault.hang.ignore_cancel

    def wants(self, path: str, address: str) -> bool:
        """Count a request of the state at `path`, and return whether the fault is due for it."""
        fault = self.fault
        if fault.crashes_at is not None or not self._path.fullmatch(path) or not self._address.fullmatch(address):
            return False
        nth = self._requests[path] = self._requests.get(path, 0) + 1
        self._matched += 1
        if fault.request not in (None, nth):
            return False
        self._in_turn += 1
        if fault.times is not None and self.applied >= fault.times:
            return False
        return fault.probability >= 1.0 or self._draw(path, nth) < fault.probability

    def why_not(self) -> str:
        """Return the reason why it was never applied."""
        fault = self.fault
        if fault.crashes_at is not None:
            return f"the run has no event {fault.crashes_at}"
        if not self._matched:
            return f"no state at {fault.at} sent a request to {fault.address}"
        if not self._in_turn:
            return f"no state made a request number {fault.request} that it matches"
        if fault.probability < 1.0:
            return f"it matched {self._in_turn} times and was not drawn, or a fault before it was applied instead"
        return "a fault before it was applied instead"

    def _draw(self, path: str, nth: int) -> float:
        return random.Random(f"{self._seed}/{self.number}/{path}/{nth}").random()  # noqa: S311 - repeatable
