"""A real session served from a thread of its own, for tests that operate runs in a browser."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine, Mapping
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any, Self, TypeVar

from editor_web.security.authentication import AccessTokens, load_access_tokens
from editor_web.server import Dashboard, dashboard
from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.event import Event
from engine.journal import Journal
from engine.project.session import Session
from engine.project.session_recordings import RECORDINGS, SessionRecordings
from engine.registry import load_states
from engine.state import State
from tests.editor_web.fake_arm import FakeArm
from tests.editor_web.limits import GUARD_S
from tests.engine.fake_states import CATALOGUE

T = TypeVar("T")

SHIFT_ID = "behaviors/shift.yaml"
SHIFT = """
flexcell: 1
name: shift
description: One state after the other, two at once, then a long wait.
parameters:
  dwell: {type: number, default: 0.0, minimum: 0, maximum: 100, unit: s, description: How long the first one takes}
userdata: {value: 0}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: first
    states:
      first: {state: test.Give, with: {after_s: "${dwell}"}, transitions: {a: set, b: bad, c: bad}}
      set: {state: flow.SetValue, with: {value: 1}, transitions: {done: both}}
      both:
        concurrency:
          states:
            left: {state: test.Give, with: {after_s: 0.01}, autonomy: {a: high}}
            right: {state: test.Give, with: {after_s: 0.01}, autonomy: {a: low}}
          conditions:
            - {finished: {left: a, right: a}}
            - {odd: {left: b}}
            - {odd: {right: b}}
            - {odd: {left: c}}
            - {odd: {right: c}}
        transitions: {finished: rest, odd: bad}
      rest: {state: flow.Wait, with: {duration_s: 3000}, resume: ask, transitions: {done: good}}
"""
NAP_ID = "behaviors/nap.yaml"
NAP = """
flexcell: 1
name: nap
outcomes: [good]
success: [good]
root:
  machine:
    initial: only
    states:
      only: {state: flow.Wait, with: {duration_s: 3000}, resume: ask, transitions: {done: good}}
"""


class Workshop:
    """`with Workshop(…) as shop`: a project with two behaviors, a bus with one arm, the page at `shop.running.url`."""

    def __init__(
        self,
        *,
        host: str,
        project: Path,
        states: Mapping[str, type[State]] = {},
        furnish: Callable[[SkillBus], None] = lambda bus: None,
        cell_view: bool = False,
    ) -> None:
        self.project = project
        self._states, self._furnish, self._cell_view = states, furnish, cell_view
        (project / "behaviors").mkdir(exist_ok=True)
        for behavior_id, text in ((SHIFT_ID, SHIFT), (NAP_ID, NAP)):
            (project / behavior_id).write_text(text, encoding="utf-8")
        self._host = host
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="workshop")
        self._open = AsyncExitStack()
        self._parts: tuple[Session, FakeArm, Dashboard] | None = None

    @property
    def session(self) -> Session:
        """The engine."""
        assert self._parts is not None
        return self._parts[0]

    @property
    def arm(self) -> FakeArm:
        """The arm `left`; change it with `on_loop`."""
        assert self._parts is not None
        return self._parts[1]

    @property
    def running(self) -> Dashboard:
        """The server."""
        assert self._parts is not None
        return self._parts[2]

    @property
    def access(self) -> AccessTokens:
        """Its tokens."""
        return load_access_tokens(self.project / "tokens")

    def call(self, work: Coroutine[Any, Any, T]) -> T:
        """Run a coroutine on the server's loop."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(timeout=GUARD_S)

    def on_loop(self, work: Callable[[], T]) -> T:
        """Call a function on the server's loop."""

        async def called() -> T:
            return work()

        return self.call(called())

    def start(self, behavior_id: str = SHIFT_ID, **more: Any) -> str:
        """Start a run from outside of the browser."""
        return self.call(self.session.start(behavior_id, parameters={}, seed=1, **more))

    def events(self, run_id: str) -> list[Event]:
        """What has happened in a run."""
        return self.on_loop(lambda: list(self.session.events(run_id)))

    def __enter__(self) -> Self:
        self._thread.start()
        self.call(self._up())
        return self

    def __exit__(self, *_: object) -> None:
        self.call(self._open.aclose())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _up(self) -> None:
        journal = self._open.enter_context(Journal.open(self.project / ".flexcell"))
        cell = await self._open.enter_async_context(OpenCell(None))
        catalogue = load_states(self.project).including({**CATALOGUE, **self._states})
        self._furnish(cell.bus)
        session = await self._open.enter_async_context(
            Session(
                cell,
                project=self.project,
                catalogue=catalogue,
                journal=journal,
                # As `flexcell serve` does; what the 3D view shows of the past it takes from there.
                recordings=SessionRecordings(self.project / ".flexcell" / RECORDINGS) if self._cell_view else None,
            )
        )
        arm = FakeArm(cell.bus, "left")
        running = await self._open.enter_async_context(
            dashboard(
                session,
                token_file=self.project / "tokens",
                host=self._host,
                cell_view=self._cell_view,
                shadows=False,
            )
        )
        self._parts = session, arm, running
