"""Prints the result of a run, for `flexcell run` and `flexcell resume`."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path

import msgspec
from rich.console import Console

from engine.cause_chain import link_text, links_from_root
from engine.cli.output.output_file import write
from engine.errors import Cause
from engine.event import Event
from engine.journal import encode_event_log
from engine.runtime.run_result import RunResult
from engine.skill import skill_words


def report_run(
    result: RunResult, log: Sequence[Event], measures: Mapping[str, float], *, as_json: bool, events: Path | None
) -> None:
    """Print the result of a run, as one JSON object or for people, and write its event log to `events`, if given."""
    encoded = encode_event_log(log)
    if as_json:
        _print_json(result, encoded, len(log), measures)
    else:
        print_result(result)
    if events is not None:
        write(events, encoded)


def _print_json(result: RunResult, encoded: bytes, count: int, measures: Mapping[str, float]) -> None:
    """Print the result as one JSON object; `encoded` is its event log."""
    document = {
        "run": result.run,
        "behavior": result.behavior,
        "status": result.status,
        "outcome": result.outcome,
        "success": result.success,
        "cause": cause_links(result.cause),
        "duration_s": result.duration_s,
        "events": count,
        "events_sha256": sha256(encoded).hexdigest(),
        "userdata": result.userdata,
        **({"measures": measures} if measures else {}),
        **({"stood_in_for": result.stood_in_for} if result.stood_in_for else {}),
    }
    sys.stdout.write(msgspec.json.encode(document).decode() + "\n")


def cause_links(cause: Cause | None) -> list[dict[str, object]]:
    """Return a cause chain for JSON output: the root cause first, the end of the run last."""
    return [
        {"message": link.message, "where": link.where, "kind": link.kind, "nodes": link.nodes}
        for link in links_from_root(cause)
    ]


def print_result(result: RunResult) -> None:
    """Print how the run ended, and the cause if it is not a success."""
    console = Console(stderr=True)
    style = "green" if result.success else "red"
    what = result.outcome or result.status
    console.print(f"[bold {style}]{what}[/] after {result.duration_s:.2f} s [dim](run {result.run})[/]")
    if result.stood_in_for:
        console.print(f"substituted nodes: {', '.join(result.stood_in_for)}", markup=False, soft_wrap=True)
    if not result.success:
        print_cause(result.cause, console)


def print_cause(cause: Cause | None, console: Console) -> None:
    """Print a cause chain, root cause first: one line per link and per node that it passed through.

    The address of a skill, which the text of a link has in words, follows in brackets.
    """
    for depth, link in enumerate(links_from_root(cause)):
        begin = f"{'  ' * depth}so " if depth else ""
        address = f" [{link.where}]" if skill_words(link.where) else ""
        console.print(f"{begin}{link_text(link)}{address}", markup=False, highlight=False, soft_wrap=True)
        for node in link.nodes:
            console.print(f"{'  ' * depth}     in {node}", markup=False, highlight=False, soft_wrap=True)
