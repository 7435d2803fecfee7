"""Stops a run in the middle of a motion of the arm."""

from __future__ import annotations

from engine.cell.open_cell import OpenCell
from engine.messages import JointState
from engine.runtime.run import Run
from tests.behaviors.application import Meanwhile

_LOOK_S = 0.02


def stop_in(path: str, *, moving_rad_s: float = 0.1) -> Meanwhile:
    """Return what stops the run as soon as it is in the state at `path` and a joint is that fast."""

    async def stop(run: Run, cell: OpenCell) -> None:
        while True:
            await cell.bus.clock.sleep(_LOOK_S)
            state = cell.bus.topic("arm/joint_state", JointState).latest
            if path in run.active_states and state is not None and max(map(abs, state.velocity_rad_s)) > moving_rad_s:
                run.stop("the test stops it")
                return

    return stop
