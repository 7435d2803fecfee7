"""A run does not go on with a real device where it had a simulated one, however that came about."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document import Cell, load_cell, parse_behavior
from engine.document.simulated_devices import with_simulated_devices
from engine.errors import ControlError
from engine.journal import RunOrigin, RunRecord
from engine.project.run_request import RunPosition, require_no_new_real_devices, require_same_devices, start_of
from engine.recording.recorded_run import RecordedRun
from engine.registry import load_states
from engine.runtime.plan import new_plan

DRIVER = ", driver: {kind: vendor_arm}"
TEXT = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nrobots:\n  left: {model: ur10%s}\n  right: {model: ur10}\n"
BEHAVIOR = """\
flexcell: 1
name: b
outcomes: [done]
root: {state: flow.Wait, with: {duration_s: 1}}
"""


def cell_of(folder: Path, *, driver: str) -> Cell:
    (folder / "cell.yaml").write_text(TEXT % driver, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def run_of(folder: Path, *, real: tuple[str, ...] | None, simulated: tuple[str, ...] = ()) -> RecordedRun:
    record = RunRecord(id="run", behavior="b", document="", status="running", epoch=1, started_unix_s=0.0, last_seq=0)
    origin = RunOrigin(behavior="b", real=real, simulated=simulated)
    return RecordedRun(place=folder, record=record, origin=origin, events=(), world=None)


def test_an_arm_that_the_document_has_made_real_since_is_refused(tmp_path: Path) -> None:
    run, cell = run_of(tmp_path, real=()), cell_of(tmp_path, driver=DRIVER)
    with pytest.raises(ControlError, match="left was simulated in this run"):
        require_same_devices(run, cell)
    with pytest.raises(ControlError, match="left was simulated in this run"):
        require_no_new_real_devices(run, cell)


def test_the_same_devices_and_fewer_real_ones_are_accepted(tmp_path: Path) -> None:
    real = cell_of(tmp_path, driver=DRIVER)
    require_same_devices(run_of(tmp_path, real=("left",)), real)
    require_no_new_real_devices(run_of(tmp_path, real=("left",)), with_simulated_devices(real, ("all",)))
    require_no_new_real_devices(run_of(tmp_path, real=()), with_simulated_devices(real, ("all",)))
    require_no_new_real_devices(run_of(tmp_path, real=()), None)


def test_of_a_run_that_did_not_record_them_only_switched_devices_are_known(tmp_path: Path) -> None:
    require_same_devices(run_of(tmp_path, real=None), cell_of(tmp_path, driver=DRIVER))


def test_a_new_run_does_not_start_with_the_data_of_one_whose_arm_was_simulated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As with `run --from`; on the page it is started at a node."""
    run = run_of(tmp_path, real=())

    def read(_place: Path | str, _run: str) -> RecordedRun:
        return run

    monkeypatch.setattr("engine.project.run_request.read_run", read)
    plan = new_plan(parse_behavior(BEHAVIOR, file="b.yaml"), load_states())
    with pytest.raises(ControlError, match="left was simulated in this run"):
        start_of(tmp_path, RunPosition(run="run", seq=1), plan, cell_of(tmp_path, driver=DRIVER))
