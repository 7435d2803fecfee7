"""Results as a Parquet file, for table libraries and databases; needs the extra `parquet`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import msgspec

from engine.errors import FlexcellError
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.report.result_rows import rows

_INTEGERS = range(-(2**63), 2**63)


def parquet_table(results: Sequence[TrialResult]) -> bytes:
    """Return the rows of results as a Parquet file: one column for each key, null where a run lacks a value.

    Numbers, texts and booleans keep their types; a column with whole and other numbers has floating-point ones. A
    column with values of several kinds, lists or mappings has them as JSON.

    Raises:
        FlexcellError: pyarrow is not installed.
    """
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError as error:
        raise FlexcellError(
            "Parquet files need pyarrow, which is not installed", hint="pip install 'flexcell[parquet]', or use .csv"
        ) from error
    # pyarrow has no types.
    arrow, files = cast("Any", pa), cast("Any", parquet)
    found = rows(results)
    names = list(found[0]) if found else ["number"]
    columns = {name: _column(arrow, [row[name] for row in found]) for name in names}
    sink = arrow.BufferOutputStream()
    files.write_table(arrow.table(columns), sink)
    return cast("bytes", sink.getvalue().to_pybytes())


def _column(arrow: Any, values: Sequence[object]) -> Any:
    kinds = {type(value) for value in values if value is not None}
    if kinds == {bool}:
        return arrow.array(values, arrow.bool_())
    if kinds == {int} and all(value is None or value in _INTEGERS for value in values):
        return arrow.array(values, arrow.int64())
    if kinds and kinds <= {int, float}:
        return arrow.array([None if value is None else float(str(value)) for value in values], arrow.float64())
    if kinds <= {str}:
        return arrow.array(values, arrow.string())
    texts = [None if value is None else msgspec.json.encode(value).decode() for value in values]
    return arrow.array(texts, arrow.string())
