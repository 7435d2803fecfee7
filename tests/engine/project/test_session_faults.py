"""Faults of one run of a session leave the other runs alone."""

from __future__ import annotations

from pathlib import Path

from engine.cell.open_cell import OpenCell
from engine.event import FaultInjected
from engine.faults import parse_faults
from engine.journal import Journal
from engine.project.session import Session
from engine.skills.gripper import ReadGripper
from tests.engine.faults.device import HEAD, STATES, Gripper

READ = """
root:
  machine:
    initial: read
    states:
      read: {state: gripper.Read, transitions: {read: good, failed: bad}}
"""


async def test_faults_belong_to_the_run_they_were_given_to(tmp_path: Path) -> None:
    """Of two runs of one behavior on one bus only the one fails."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "behaviors" / "read.yaml").write_text(HEAD + READ, encoding="utf-8")
    faults = parse_faults("flexcell: 1\nfaults: [{error: no answer}]\n", file="faults.yaml")
    with Journal.open(tmp_path / "journal") as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=tmp_path, catalogue=STATES, journal=journal) as session,
        ):
            cell.bus.advertise_service(ReadGripper, Gripper().read, namespace="left/gripper")
            faulty = await session.start("behaviors/read.yaml", parameters={}, seed=0, faults=faults)
            sound = await session.start("behaviors/read.yaml", parameters={}, seed=0)
            outcomes = [(await session.wait(run)).outcome for run in (faulty, sound)]
            injected = [sum(isinstance(e, FaultInjected) for e in session.events(run)) for run in (faulty, sound)]
    assert (outcomes, injected) == (["bad", "good"], [1, 0])
