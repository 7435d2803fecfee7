"""The virtual event loop of a replay: it can run one callback before all other ready callbacks."""

from __future__ import annotations

from collections.abc import Callable

from engine.clock import VirtualLoop
from engine.runtime.scheduling.ready_queue import ready_queue


class ReplayLoop(VirtualLoop):
    """A `VirtualLoop` whose queue can be jumped.

    In the recorded run an answer came between two other events of one instant, and the order of
    the queue then is not known any more; the order of the events is.
    """

    def run_before_ready(self, callback: Callable[[], object]) -> None:
        """Call back, and run what becomes ready by it before what is ready already."""
        ready = ready_queue(self)
        before = len(ready)
        callback()
        woken = [ready.pop() for _ in range(len(ready) - before)]
        ready.extendleft(woken)
