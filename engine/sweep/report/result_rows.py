"""Results as rows, for spreadsheets, notebooks and other programs."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

import msgspec

from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.summary import SweepSummary
from engine.sweep.verdict.comparison import Comparison

Row = dict[str, object]


def rows(results: Sequence[TrialResult]) -> list[Row]:
    """Return one flat row for each result; all have the same keys.

    Factors have their addresses, userdata at the end `outputs.KEY`, measures `measures.NAME`, times in nodes
    `seconds.PATH`; what a run lacks is None.
    """
    outputs = sorted({key for result in results for key in result.outputs})
    measures = list(dict.fromkeys(name for result in results for name in result.measures))
    paths = list(dict.fromkeys(path for result in results for path in result.nodes))
    return [
        {
            "number": result.configuration.number,
            "seed": result.configuration.seed,
            **{address: value for address, value in result.configuration.values.items() if address != "seed"},
            "status": result.status,
            "outcome": result.outcome,
            "success": result.success,
            "reason": result.reason or None,
            "reason_at": result.reason_at or None,
            "duration_s": result.duration_s,
            "events": result.events,
            "events_sha256": result.events_sha256,
            "wall_s": result.wall_s,
            "cpu_s": result.cpu_s,
            **{f"outputs.{key}": result.outputs.get(key) for key in outputs},
            **{f"measures.{name}": result.measures.get(name) for name in measures},
            **{f"seconds.{path}": node.total_s if (node := result.nodes.get(path)) else None for path in paths},
        }
        for result in results
    ]


def csv_table(results: Sequence[TrialResult]) -> str:
    """Return the rows as CSV with a header; lists and mappings are JSON."""
    found = rows(results)
    text = io.StringIO()
    writer = csv.DictWriter(text, fieldnames=list(found[0]) if found else ["number"], lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: _cell(value) for key, value in row.items()} for row in found)
    return text.getvalue()


def json_report(summary: SweepSummary, comparison: Comparison | None) -> bytes:
    """Return all figures of a sweep and the results as one JSON object."""
    interval = summary.interval
    document: Row = {
        "behavior": summary.sweep.document.behavior,
        "subject": summary.subject,
        "versions": summary.versions,
        "planned": summary.planned,
        "done": summary.done,
        "looked_at": summary.looked_at,
        "successes": summary.successes,
        "rate": summary.rate,
        "interval": list(interval) if interval is not None else None,
        "confidence": summary.sweep.document.confidence,
        "requirements": summary.requirements,
        "verdict": summary.verdict,
        "ended_by": summary.ended_by,
        "outcomes": summary.outcomes,
        "causes": summary.causes,
        "duration_s": summary.duration_s,
        "nodes": summary.nodes,
        "outputs": summary.outputs,
        "measures": summary.measures,
        "effects": summary.effects,
        "inputs": summary.inputs,
        "coverage": {"items": summary.items, "missing": summary.missing},
        "comparison": comparison,
        "cpu_s": summary.cpu_s,
        "results": rows(summary.results),
    }
    return msgspec.json.format(msgspec.json.encode(document), indent=1)


def _cell(value: object) -> object:
    return msgspec.json.encode(value).decode() if isinstance(value, list | tuple | dict) else value
