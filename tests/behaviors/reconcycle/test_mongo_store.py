"""Behaviors of the demo cell with its entries on a MongoDB server: overwriting one changes the motion alone."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from engine.clock import run_virtual
from engine.document.cell import Cell
from engine.event import NodeExited
from engine.journal import encode_event_log
from engine.store import EntryChange, Joints, decode_entry, open_store
from tests.behaviors.reconcycle.test_two_arm_transfer import Transfer, cell_as_it_is, changed_cell
from tests.engine.store.mongod import RUNS_HERE, Mongod

SEED = 7
HOMEWARD = """\
flexcell: 1
name: homeward
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: aside
    states:
      aside:
        state: motion.MoveJoints
        with: {robot: left, target: [0.5, -0.785, 0, -2.356, 0, 1.571, 0.785]}
        transitions: {reached: home, failed: failed}
      home:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: left_home}}
        transitions: {reached: finished, failed: failed}
"""


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mongod]:
    """A replica set of one server."""
    if not RUNS_HERE:
        pytest.skip("the MongoDB server of the tests runs on Linux x86-64 only")
    mongod = Mongod(replicated=True, folder=tmp_path_factory.mktemp("mongod"))
    mongod.start()
    yield mongod
    mongod.remove()


def on_server(server: Mongod, database: str, folder: Path) -> Cell:
    """The demo cell with its entries on the server."""
    store = f"store: {{kind: mongodb, uri: '{server.uri}', database: {database}, seed: ../entries/dual_panda.yaml}}"
    return changed_cell(folder, lambda text: re.sub("(?m)^store: .*", store, text))


def ran(cell: Cell, store: Path | None = None, *, homeward: Path | None = None) -> Transfer:
    """The transfer, or a short motion home, run to its good end."""
    transfer = Transfer(cell, SEED, behavior=homeward) if homeward is not None else Transfer(cell, SEED)
    assert transfer.run(store).outcome == "finished"
    return transfer


@pytest.mark.nightly
def test_the_run_is_the_same_with_either_store(server: Mongod, tmp_path: Path) -> None:
    """Byte for byte, in virtual time."""
    with_file = ran(cell_as_it_is(), tmp_path / "store.db")
    with_server = ran(on_server(server, "same", tmp_path))
    assert encode_event_log(with_server.log) == encode_event_log(with_file.log)


def test_overwriting_an_entry_changes_the_motion_of_the_next_run_and_not_the_behavior(
    server: Mongod, tmp_path: Path
) -> None:
    """Another resting place for the left arm; undone, the arm moves as before."""
    cell = on_server(server, "taught", tmp_path)
    address = f"{server.uri}/taught"
    behavior = tmp_path / "homeward.yaml"
    behavior.write_text(HOMEWARD, encoding="utf-8")
    first = ran(cell, homeward=behavior)
    home = run_virtual(_turned(address, by_rad=0.3))
    second = ran(cell, homeward=behavior)
    run_virtual(_undone(address))
    third = ran(cell, homeward=behavior)
    assert second.joints[-1][0] == pytest.approx(home, abs=0.01)
    assert abs(second.joints[-1][0][0] - first.joints[-1][0][0]) == pytest.approx(0.3, abs=0.01)
    assert _path_taken(first) == _path_taken(second) == _path_taken(third)
    assert third.joints == first.joints


async def _turned(address: str, *, by_rad: float) -> tuple[float, ...]:
    """Turn the base joint of `left_home` and return its joints."""
    async with await open_store(address, inline=True) as store:
        entry = await store.get("joints", "left_home")
        first, *others = decode_entry(entry, Joints).joints
        turned = Joints(joints=(first + by_rad, *others))
        await store.put("joints", "left_home", turned, expected_revision=entry.revision, by="ana", reason="more room")
        return turned.joints


async def _undone(address: str) -> EntryChange:
    async with await open_store(address, inline=True) as store:
        return await store.undo("joints", "left_home")


def _path_taken(transfer: Transfer) -> list[tuple[str, str]]:
    return [(event.path, event.outcome) for event in transfer.log if isinstance(event, NodeExited)]
