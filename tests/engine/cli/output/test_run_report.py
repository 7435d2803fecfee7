"""What `flexcell run --json` prints of a run."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace

import pytest

from engine.cli.output.run_report import report_run
from engine.errors import Cause
from engine.runtime.run_result import RunResult

RESULT = RunResult(
    run="r-1",
    behavior="move",
    status="finished",
    outcome="done",
    success=True,
    cause=None,
    duration_s=2.0,
    userdata={},
)


@pytest.mark.parametrize("measures", [{"left.path_m": 0.25, "cell.contacts": 0.0}, {}])
def test_measures_are_printed_where_a_device_has_some(
    capsys: pytest.CaptureFixture[str], measures: Mapping[str, float]
) -> None:
    report_run(RESULT, [], measures, as_json=True, events=None)
    printed = json.loads(capsys.readouterr().out)
    assert printed.get("measures", {}) == measures
    assert ("measures" in printed) == bool(measures)


def test_a_cause_names_robot_and_motion_in_words_and_its_address_besides(capsys: pytest.CaptureFixture[str]) -> None:
    limit = Cause(message="joint 4 would exceed its limit", where="left/cart_lin_task", kind="GoalRejected")
    cause = Cause(message="left did not move", where="root/reach", kind="motion.MoveLinear", because=limit)
    result = replace(RESULT, outcome="failed", success=False, cause=cause)
    report_run(result, [], {}, as_json=False, events=None)
    lines = capsys.readouterr().err.splitlines()
    assert lines[1:] == [
        "left arm: line to a pose: joint 4 would exceed its limit [left/cart_lin_task]",
        "  so root/reach: left did not move",
    ]
    report_run(result, [], {}, as_json=True, events=None)
    links = json.loads(capsys.readouterr().out)["cause"]
    assert [(link["message"], link["where"]) for link in links] == [
        ("joint 4 would exceed its limit", "left/cart_lin_task"),
        ("left did not move", "root/reach"),
    ]
