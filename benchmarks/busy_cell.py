"""The demo cell with everything on: a behavior that moves both arms, journal, recorder, dashboard, a viewer."""

from __future__ import annotations

import asyncio
import json
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path

from editor_web.server import dashboard
from engine.cell.open_cell import OpenCell
from engine.cli.inputs import read_behavior, read_cell
from engine.journal import Journal
from engine.project.cell_runner import CellRunner
from engine.project.run_recorder import open_recorder
from engine.project.run_request import RunRequest
from engine.project.session import Session
from engine.recording import RecordingOptions, collect_documents
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.skills.arm_control import ControllerName
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld

BEHAVIOR = Path(__file__).with_name("two_arms_for_ever.yaml")
_ROOT = Path(__file__).parents[1]


@dataclass(kw_only=True)
class BusyCell:
    """A cell at work. `recording` and `viewer` report what was written and seen, once it is closed."""

    cell: OpenCell
    host: ProcessHost
    run: Run
    viewer_pid: int
    recording: Path
    events: int = 0
    seen: dict[str, int] = field(default_factory=dict[str, int])


@asynccontextmanager
async def busy_cell(controller: ControllerName, *, folder: Path, browser: bool = False) -> AsyncGenerator[BusyCell]:
    """Open the cell and let the behavior run until the block ends; all files go to `folder`."""
    catalogue = load_states()
    behavior, _ = read_behavior(BEHAVIOR, catalogue)
    document = read_cell(None, behavior)
    order = RecordingOptions(path=folder / "run.mcap", documents=collect_documents(behavior, document))
    with Journal.open(folder) as journal:
        async with (
            open_recorder(order, inline=False) as recorder,
            OpenCell(document, store_path=str(folder / "store.db")) as cell,
            Session(cell, project=_ROOT, catalogue=catalogue, journal=journal) as session,
            dashboard(session, token_file=folder / "tokens", shadows=browser) as page,
        ):
            assert isinstance(cell.world, SimWorld)
            assert isinstance(cell.world.host, ProcessHost)
            viewer = await _viewer(page.url, page.token, browser=browser)
            runner = CellRunner(cell, journal, recorder=recorder)
            prepared = await runner.start(
                RunRequest(
                    plan=new_plan(behavior, catalogue),
                    parameters={"controller": controller},
                    documents=order.documents,
                )
            )
            run = prepared.run
            busy = BusyCell(cell=cell, host=cell.world.host, run=run, viewer_pid=viewer.pid, recording=order.path)
            run.watch(lambda event: setattr(busy, "events", event.seq))
            running = asyncio.create_task(prepared.execute(), name="the behavior")
            try:
                yield busy
            finally:
                run.stop("it was long enough")
                result = await running
                busy.seen = await _closed(viewer)
            if result.status != "stopped":
                raise RuntimeError(f"the behavior ended by itself: {result.cause}")


async def _viewer(url: str, token: str, *, browser: bool) -> Process:
    options = ("--browser",) if browser else ()
    viewer = await asyncio.create_subprocess_exec(
        sys.executable, "-P", "-m", "benchmarks.viewer", url, token, *options, stdin=PIPE, stdout=PIPE, cwd=_ROOT
    )
    assert viewer.stdout is not None
    if await viewer.stdout.readline() != b"ready\n":
        raise RuntimeError("the viewer did not start; see above")
    return viewer


async def _closed(viewer: Process) -> dict[str, int]:
    out, _ = await viewer.communicate(b"")
    return json.loads(out)
