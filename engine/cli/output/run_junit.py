"""Writes the JUnit file of `flexcell run --junit` for a CI server."""

from __future__ import annotations

from pathlib import Path

from engine.cause_chain import describe_cause, link_text, links_from_root
from engine.cli.output.junit import JunitCase, JunitProblem, JunitSuite, class_name, write_junit
from engine.runtime.plan import Plan
from engine.runtime.run_result import RunResult


def write_run_junit(path: Path, file: Path, plan: Plan, result: RunResult, *, seed: int | None, clock: str) -> None:
    """Write the file: one suite with one case.

    Raises:
        FlexcellError: the file cannot be written.
    """
    case = JunitCase(name=plan.name, classname=class_name(file), time_s=result.duration_s, problem=_problem(result))
    properties = {
        "run": result.run,
        "behavior": plan.name,
        "document_sha256": plan.document_hash,
        "seed": "" if seed is None else str(seed),
        "clock": clock,
        "status": result.status,
        "outcome": result.outcome or "",
    }
    write_junit(path, [JunitSuite(name=plan.name, file=str(file), cases=(case,), properties=properties)])


def _problem(result: RunResult) -> JunitProblem | None:
    if result.success:
        return None
    cause = describe_cause(result.cause) if result.cause is not None else ""
    end = result.outcome or result.status
    return JunitProblem(
        kind="failure" if result.status == "finished" else "error",
        type=end,
        message=cause or end,
        text="\nso ".join(map(link_text, links_from_root(result.cause))) or end,
    )
