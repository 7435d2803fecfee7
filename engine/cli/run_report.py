"""What `flexcell run` and `flexcell resume` print of a run that is over."""

from __future__ import annotations

import sys
from hashlib import sha256
from typing import Any

import msgspec
from rich.console import Console

from engine.cause import describe
from engine.event import Cause
from engine.run import RunResult


def print_json(result: RunResult, encoded: bytes, count: int) -> None:
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
    }
    sys.stdout.write(msgspec.json.encode(document).decode() + "\n")


def cause_links(cause: Cause | None) -> list[dict[str, object]]:
    """Return a cause chain as the commands give it to machines."""
    chain = cause.chain() if cause else ()
    return [{"message": link.message, "where": link.where, "kind": link.kind, "nodes": link.nodes} for link in chain]


def print_result(result: RunResult) -> None:
    """Say how it ended, and why where it is no success."""
    console = Console(stderr=True)
    style = "green" if result.success else "red"
    what = result.outcome or result.status
    console.print(f"[bold {style}]{what}[/] after {result.duration_s:.2f} s [dim](run {result.run})[/]")
    if not result.success:
        print_cause(result.cause, console)


def print_cause(cause: Cause | None, console: Console) -> None:
    """Print a cause chain, a line for each link and each node that it came through."""
    for depth, link in enumerate(cause.chain() if cause is not None else ()):
        console.print(f"{'  ' * depth}because {describe_link(link)}", markup=False, highlight=False, soft_wrap=True)
        for node in link.nodes:
            console.print(f"{'  ' * depth}        in {node}", markup=False, highlight=False, soft_wrap=True)


def describe_link(link: Any) -> str:
    """Write one link of a cause chain without what is below it."""
    return describe(msgspec.structs.replace(link, because=None))
