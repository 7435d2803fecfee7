"""What workers are sent: a sweep that is the same in another folder, with nothing left of the first one."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import msgspec
import pytest

from engine.clock import run_virtual
from engine.document.sweep import parse_sweep
from engine.errors import DocumentError
from engine.skills.entries import EntryRecord
from engine.store import SqliteStore
from engine.sweep import SweepSubject, configurations
from engine.sweep.cluster.shipment import Shipment, pack
from tests.engine.sweep.luck_project import LuckProject

CELL = """\
flexcell: 1
cell: table
store: {kind: sqlite, path: STORE, seed: entries.yaml}
world: {kind: mujoco}
robots:
  left: {model: ../arms/mine}
"""
FAULTS = "flexcell: 1\nfaults: [{at: root/only, error: broken}]\n"
ENTRIES = "flexcell: 1\n"


@pytest.fixture
def project(tmp_path: Path) -> LuckProject:
    folder = tmp_path / "here"
    (folder / "cells").mkdir(parents=True)
    (folder / "arms" / "mine").mkdir(parents=True)
    store = tmp_path / "elsewhere.db"
    run_virtual(_with_an_entry(store))
    (folder / "cells" / "cell.yaml").write_text(CELL.replace("STORE", str(store)), encoding="utf-8")
    (folder / "cells" / "entries.yaml").write_text(ENTRIES, encoding="utf-8")
    (folder / "arms" / "mine" / "robot.yaml").write_text("flexcell: 1\n", encoding="utf-8")
    (folder / "slip.yaml").write_text(FAULTS, encoding="utf-8")
    return LuckProject(folder)


async def _with_an_entry(file: Path) -> None:
    async with SqliteStore.open(file, inline=True) as store:
        await store.seed([EntryRecord(kind="joints", name="taught", value={"joints": [0.5]}, revision=1)])


def _subject(folder: Path, document: str) -> SweepSubject:
    return SweepSubject.load(parse_sweep(document, file=folder / "sweep.yaml"))


def _document(**keys: object) -> str:
    return msgspec.json.encode({"flexcell": 1, "behavior": "luck.yaml", **keys}).decode()


def _unpacked(project: LuckProject, shipment: Shipment, there: Path) -> SweepSubject:
    """Load a shipment in another folder, when there is nothing left of the first one, as in another process."""
    shipment.unpack(there)
    shutil.rmtree(project.path)
    for name in (project.module, "luck_tools"):
        sys.modules.pop(name, None)
    return SweepSubject.load(parse_sweep(shipment.document, file=there / shipment.file))


def test_a_sweep_is_the_same_where_it_is_unpacked(project: LuckProject, tmp_path: Path) -> None:
    helper = project.path / "luck_tools.py"
    helper.write_text("LIMIT = 3\n", encoding="utf-8")
    module = project.path / f"{project.module}.py"
    module.write_text(f"import luck_tools\n{module.read_text(encoding='utf-8')}", encoding="utf-8")
    subject = _subject(
        project.path,
        _document(cell="cells/cell.yaml", factors={"faults": {"values": ["none", "slip.yaml"]}}, runs=2),
    )
    shipment = msgspec.msgpack.decode(msgspec.msgpack.encode(pack(subject)), type=Shipment)
    there = tmp_path / "there"
    (tmp_path / "elsewhere.db").unlink()
    unpacked = _unpacked(project, shipment, there)
    assert unpacked.versions == subject.versions
    assert unpacked.store_file is not None
    assert unpacked.store_file.is_relative_to(there)
    assert configurations(unpacked.sweep) == configurations(subject.sweep)
    assert {name for name in shipment.files if name.endswith(".py")} == {module.name, helper.name}


def test_what_a_sweep_names_absolutely_is_sent_under_a_relative_path(project: LuckProject, tmp_path: Path) -> None:
    text = _document(behavior=str(project.behavior), cell=str(project.path / "cells" / "cell.yaml"))
    subject = _subject(tmp_path, text)
    shipment = pack(subject)
    assert str(tmp_path) not in shipment.document
    assert _unpacked(project, shipment, tmp_path / "there").hash == subject.hash


def test_an_absolute_path_that_a_run_follows_is_refused(project: LuckProject) -> None:
    text = _document(factors={"faults": {"values": [str(project.path / "slip.yaml")]}})
    with pytest.raises(DocumentError, match="an absolute path, which leads elsewhere on a worker"):
        pack(_subject(project.path, text))
    cell = project.path / "cells" / "cell.yaml"
    cell.write_text(CELL.replace("entries.yaml", str(cell.with_name("entries.yaml"))), encoding="utf-8")
    with pytest.raises(DocumentError, match=r"entries.yaml` is an absolute path"):
        pack(_subject(project.path, _document(cell="cells/cell.yaml")))
