"""Results as a Parquet file, read back."""

from __future__ import annotations

import io
from typing import Any, cast

from pyarrow import parquet

from engine.sweep import Configuration, TrialResult
from engine.sweep.execution.trial_result import NodeTime
from engine.sweep.report import parquet_table
from engine.sweep.report.result_rows import rows

RESULTS = [
    TrialResult(
        configuration=Configuration(
            number=0, seed=2**53, values={"parameters.n": 3, "parameters.x": 1, "faults": "none", "parameters.on": True}
        ),
        status="finished",
        outcome="done",
        success=True,
        duration_s=1.5,
        outputs={"force_n": 2.5},
        nodes={"root/only": NodeTime(visits=1, total_s=1.5)},
    ),
    TrialResult(
        configuration=Configuration(
            number=1, seed=7, values={"parameters.n": 4, "parameters.x": 0.5, "faults": "a.yaml", "parameters.on": [1]}
        ),
        status="crashed",
        reason="„ended“ by SIGKILL",
    ),
]


def _read(data: bytes) -> Any:
    return cast("Any", parquet).read_table(io.BytesIO(data))


def test_columns_have_the_types_of_their_values() -> None:
    table = _read(parquet_table(RESULTS))
    types = {field.name: str(field.type) for field in table.schema}
    assert types == {
        "number": "int64", "seed": "int64", "parameters.n": "int64", "parameters.x": "double", "faults": "string",
        "parameters.on": "string", "status": "string", "outcome": "string", "success": "bool", "reason": "string",
        "reason_at": "string", "duration_s": "double", "events": "int64", "events_sha256": "string",
        "wall_s": "double", "cpu_s": "double", "outputs.force_n": "double", "seconds.root/only": "double",
    }  # fmt: skip


def test_what_is_read_back_is_what_was_written() -> None:
    """Only the column of two kinds is text."""
    expected = [{**row, "parameters.on": text} for row, text in zip(rows(RESULTS), ["true", "[1]"], strict=True)]
    assert _read(parquet_table(RESULTS)).to_pylist() == expected


def test_a_sweep_without_results_has_no_rows() -> None:
    assert _read(parquet_table([])).num_rows == 0
