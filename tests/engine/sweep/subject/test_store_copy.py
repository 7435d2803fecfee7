"""Versions of a sweep are told apart by the entries that its runs find, not by the file that has them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from engine.cell.cell_store import open_cell_store
from engine.clock import run_virtual
from engine.document.cell import Cell, load_cell
from engine.document.entries_document import load_entries
from engine.skills.entries import EntryRecord
from engine.sweep.subject.store_copy import entries_hash

SEED = "flexcell: 1\njoints: {home: [0.0, 1.0]}\n"


@pytest.fixture
def cell(tmp_path: Path) -> Cell:
    (tmp_path / "seed.yaml").write_text(SEED, encoding="utf-8")
    text = f"flexcell: 1\ncell: bench\nstore: {{kind: sqlite, path: {tmp_path / 'bench.db'}, seed: seed.yaml}}\n"
    (tmp_path / "cell.yaml").write_text(text, encoding="utf-8")
    return load_cell(tmp_path / "cell.yaml")


def _opened(cell: Cell, tmp_path: Path, entries: Sequence[EntryRecord], *, overwrite: bool = False) -> Path:
    """The file of its store after these entries were written."""

    async def write() -> None:
        async with await open_cell_store(cell, inline=True) as store:
            await store.seed(entries, by="somebody", reason="at some time", overwrite=overwrite)

    run_virtual(write())
    return tmp_path / "bench.db"


def test_a_store_with_nothing_but_the_seed_is_as_none(cell: Cell, tmp_path: Path) -> None:
    before = entries_hash(cell, None)
    seed = load_entries(tmp_path / "seed.yaml").records()
    assert entries_hash(cell, _opened(cell, tmp_path, ())) == before
    assert entries_hash(cell, _opened(cell, tmp_path, seed)) == before


def test_an_entry_that_was_taught_or_seeded_makes_another_version(cell: Cell, tmp_path: Path) -> None:
    seed = load_entries(tmp_path / "seed.yaml").records()
    store = _opened(cell, tmp_path, seed)
    before = entries_hash(cell, store)
    (home,) = seed
    _opened(cell, tmp_path, [EntryRecord(kind=home.kind, name="away", value=home.value, revision=1)])
    taught = entries_hash(cell, store)
    (tmp_path / "seed.yaml").write_text(SEED.replace("home:", "rest:"), encoding="utf-8")
    assert len({before, taught, entries_hash(cell, store)}) == 3


def test_a_cell_without_a_store_has_no_entries(tmp_path: Path) -> None:
    (tmp_path / "cell.yaml").write_text("flexcell: 1\ncell: bench\n", encoding="utf-8")
    assert entries_hash(load_cell(tmp_path / "cell.yaml"), None) == ""
