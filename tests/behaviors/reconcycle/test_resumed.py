"""The transfer is killed with a part in each hand; a session, and the command line, carry both parts on from there."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import load_cell
from engine.event import NodeExited
from engine.journal import Journal
from engine.project.session import Session
from engine.registry import load_states
from tests.engine.cli.command import flexcell
from tests.engine.cli.process import JOURNAL, events_in, run_id_in

ROOT = Path(__file__).parents[3]
TRANSFER = "behaviors/reconcycle/two_arm_transfer.yaml"
CELL = ROOT / "behaviors" / "cells" / "dual_panda.yaml"
CRASH = "flexcell: 1\nfaults: [{crash: {at_event: 105}}]\n"


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the journal of the killed run."""
    folder = tmp_path_factory.mktemp("killed")
    (folder / "crash.yaml").write_text(CRASH, encoding="utf-8")
    said = flexcell("run", ROOT / TRANSFER, "--clock", "virtual", "-q", "--faults", "crash.yaml", cwd=folder)
    assert said.code == -9
    grasped = [
        event.path for event in events_in(folder) if isinstance(event, NodeExited) and event.path.endswith("grasp")
    ]
    assert sorted(grasped) == ["root/transfer/left/grasp", "root/transfer/right/grasp"]
    return folder


def copied(killed: Path, tmp_path: Path) -> Path:
    """Return a folder with a journal of its own."""
    shutil.copytree(killed / JOURNAL, tmp_path / JOURNAL)
    return tmp_path


def test_a_session_brings_the_world_back_and_carries_on(killed: Path, tmp_path: Path) -> None:
    folder = copied(killed, tmp_path)
    run = run_id_in(folder)

    async def main() -> str | None:
        with Journal.open(folder / JOURNAL, inline=True) as journal:
            async with (
                OpenCell(load_cell(CELL), store_path=str(folder / "store.db")) as cell,
                Session(cell, project=ROOT, catalogue=load_states(), journal=journal) as session,
            ):
                return (await session.wait(await session.resume(run))).outcome

    assert run_virtual(main()) == "finished"
    again = [e.path for e in events_in(folder) if isinstance(e, NodeExited) and e.path.endswith("grasp")]
    assert len(again) == 2


def test_a_new_run_may_begin_there_in_the_same_world(killed: Path, tmp_path: Path) -> None:
    """At another event the world is not known, which is said."""
    folder = copied(killed, tmp_path)
    run = run_id_in(folder)
    at = json.loads(flexcell("runs", "show", run, "--json", cwd=folder).out)["world_at"]
    said = flexcell("run", ROOT / TRANSFER, "--clock", "virtual", "-q", "--from", f"{run}@{at}", cwd=folder)
    assert (said.code, "is not restored" in said.err) == (0, False)
    said = flexcell(
        "run", ROOT / TRANSFER, "--clock", "virtual", "-q", "--from", f"{run}@{at - 1}", "--timeout", "0.01", cwd=folder
    )
    assert f"the cell is not restored: its world is known at event {at} only" in said.err
