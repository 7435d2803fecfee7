"""`flexcell check --store` and the start of a run say which named entries a real store lacks."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.clock import run_virtual
from engine.store import SqliteStore
from tests.engine.cli.command import flexcell

BEHAVIOR = """flexcell: 1
name: example
cell: bench.yaml
outcomes: [done, failed]
success: [done]
root:
  machine:
    initial: home
    states:
      home:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: left_taught}}
        transitions: {reached: done, failed: failed}
"""
CELL = """flexcell: 1
cell: bench
store: {kind: sqlite, path: bench.db, seed: entries.yaml}
world: {kind: mujoco}
robots: {left: {model: servo_arm}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A behavior that uses an entry which its cell is not seeded with."""
    (tmp_path / "b.yaml").write_text(BEHAVIOR)
    (tmp_path / "bench.yaml").write_text(CELL)
    (tmp_path / "entries.yaml").write_text("flexcell: 1\njoints:\n  left_home: [0, 0, 0, 0, 0, 0, 0]\n")
    return tmp_path


def _teach(file: Path) -> None:
    async def teach() -> None:
        async with SqliteStore.open(file, inline=True) as store:
            await store.put("joints", "left_taught", {"joints": [0.0, 0.0]})

    run_virtual(teach())


def test_an_entry_that_was_taught_is_no_finding_any_more(folder: Path) -> None:
    """Against the seed it is missing; against the cell's own store, and one named by its path, it is there."""
    missing = "[missing-entry]"
    assert missing in flexcell("check", "b.yaml", cwd=folder).out
    assert missing in flexcell("check", "b.yaml", "--store", "cell", cwd=folder).out
    assert not (folder / "bench.db").exists()
    _teach(folder / "bench.db")
    assert missing not in flexcell("check", "b.yaml", "--store", "cell", cwd=folder).out
    assert missing not in flexcell("check", "b.yaml", "--store", "bench.db", cwd=folder).out
    assert missing in flexcell("check", "b.yaml", cwd=folder).out


def test_a_store_that_is_not_there_is_reported(folder: Path) -> None:
    """A mistyped path makes no file."""
    result = flexcell("check", "b.yaml", "--store", "typo.db", cwd=folder)
    assert result.code == 2
    assert "typo.db: there is no such store file" in result.out + result.err
    assert not (folder / "typo.db").exists()


def test_the_start_of_a_run_warns_of_what_its_store_lacks(folder: Path) -> None:
    """It runs all the same: a behavior may write the entry before it needs it."""
    result = flexcell("run", "b.yaml", "--clock", "virtual", "-q", cwd=folder)
    assert "there is no joints entry `left_taught`" in result.err
    _teach(folder / "bench.db")
    assert (
        "left_taught" not in flexcell("run", "b.yaml", "--clock", "virtual", "-q", cwd=folder).err.split("errored")[0]
    )
