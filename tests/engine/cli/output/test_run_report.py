"""What `flexcell run --json` prints of a run."""

from __future__ import annotations

import json
from collections.abc import Mapping

import pytest

from engine.cli.output.run_report import report_run
from engine.runtime.run import RunResult

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
