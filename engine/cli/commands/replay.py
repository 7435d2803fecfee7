"""`flexcell replay`: executes recorded runs again and reports the first difference."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from engine.cli.exit_code import ExitCode
from engine.cli.output.junit import JunitCase, JunitProblem, JunitSuite, class_name, write_junit
from engine.cli.output.output_file import prepare
from engine.document import load_behavior
from engine.errors import FlexcellError
from engine.recording import Recording, load_recording, recorded_measures
from engine.recording.recorded_run import read_run
from engine.registry import load_states
from engine.replay import ReplayDifference, ReplayReport, recording_from_journal
from engine.replay import replay as replay_recording
from engine.runtime.plan import Catalogue


def replay(
    recordings: Annotated[
        list[str],
        typer.Argument(
            metavar="REC...",
            help="Recordings of `flexcell run --record`; with --journal, ids of runs.",
            show_default=False,
        ),
    ],
    behavior: Annotated[
        Path | None, typer.Option(help="Execute this version of the behavior instead of the recorded one.")
    ] = None,
    journal: Annotated[Path | None, typer.Option(help="Replay runs of the journal in this folder.")] = None,
    junit: Annotated[Path | None, typer.Option(help="Write the results to this file as JUnit XML.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the results as one JSON object on stdout.")] = False,
) -> None:
    """Replay recorded runs in virtual time and without robots: recorded responses replace the devices.

    Exit code 0: every event is the same. 4: the runs differ; the first different event is printed, and so are
    events that were altered after the run, and parameters whose default is another one in `--behavior`.
    2: a recording or the behavior cannot be used.
    """
    prepare(junit)
    # Not from the folder of a recording or from paths in it: its author must not decide which code runs.
    catalogue = load_states(Path.cwd())
    results = [_replayed(name, catalogue, behavior, journal) for name in recordings]
    if junit is not None:
        write_junit(junit, [_suite(*each) for each in zip(recordings, results, strict=True)])
    if json:
        _print_json(recordings, results, from_files=journal is None)
    else:
        for name, result in zip(recordings, results, strict=True):
            sys.stderr.writelines(f"{line}\n" for line in _lines(name, result))
    raise typer.Exit(_exit_code(results))


def _replayed(
    name: str, catalogue: Catalogue, behavior: Path | None, journal: Path | None
) -> ReplayReport | FlexcellError:
    """Replay one recording; the error of an invalid one is returned, so that the others still run."""
    try:
        changed = load_behavior(behavior) if behavior is not None else None
        return replay_recording(_load(name, journal), catalogue, behavior=changed)
    except FlexcellError as error:
        return error


def _load(name: str, journal: Path | None) -> Recording:
    return load_recording(Path(name)) if journal is None else recording_from_journal(read_run(journal, name))


def _exit_code(results: list[ReplayReport | FlexcellError]) -> ExitCode:
    if any(isinstance(result, FlexcellError) for result in results):
        return ExitCode.BAD_INPUT
    if any(isinstance(result, ReplayReport) and not result.same for result in results):
        return ExitCode.REPLAY_DIFFERS
    return ExitCode.SUCCESS


def _lines(name: str, result: ReplayReport | FlexcellError) -> Iterator[str]:
    if isinstance(result, FlexcellError):
        # Most errors name the file already.
        yield f"flexcell: {result}" if name in str(result) else f"flexcell: {name}: {result}"
        return
    if result.difference is None:
        cut = "" if result.recording.complete else ", up to the end of the truncated recording"
        yield f"{name}: the same, {result.compared} events{cut}"
        return
    for number, difference in enumerate(result.differences):
        yield f"{name}: {'also ' if number else ''}differs: {difference}"
        yield from (f"  after {line}" for line in difference.before)


def _print_json(names: list[str], results: list[ReplayReport | FlexcellError], *, from_files: bool) -> None:
    rows = [_row(name, result, from_file=from_files) for name, result in zip(names, results, strict=True)]
    sys.stdout.write(msgspec.json.encode({"replays": rows}).decode() + "\n")


def _row(name: str, result: ReplayReport | FlexcellError, *, from_file: bool) -> dict[str, object]:
    if isinstance(result, FlexcellError):
        return {"recording": name, "status": "unusable", "error": str(result)}
    description = result.recording.description
    # A journal has no topics.
    measures = recorded_measures(result.recording.path) if from_file else {}
    return {
        "recording": name,
        "status": "same" if result.same else "differs",
        "run": description.run,
        "behavior": description.behavior,
        "events": result.compared,
        "complete": result.recording.complete,
        "records": _records(result.recording),
        "difference": _difference(result.difference),
        "differences": [_difference(each) for each in result.differences],
        "duration_s": round(result.duration_s, 6),
        **({"measures": measures} if measures else {}),
    }


def _records(recording: Recording) -> str:
    """Return whether the events are those that the run wrote, in a word."""
    if recording.altered is None:
        return "unverified"
    return "altered" if recording.altered else "verified"


def _difference(difference: ReplayDifference | None) -> dict[str, object] | None:
    if difference is None:
        return None
    return {
        "event": difference.number,
        "time_s": difference.time_s,
        "path": difference.path,
        "recorded": difference.recorded,
        "replayed": difference.replayed,
        "detail": difference.detail,
        "before": difference.before,
        "message": str(difference),
    }


def _suite(name: str, result: ReplayReport | FlexcellError) -> JunitSuite:
    if isinstance(result, FlexcellError):
        problem = JunitProblem(kind="error", type="unusable", message=str(result))
        case = JunitCase(name=name, classname="replay", time_s=0.0, problem=problem)
        return JunitSuite(name=name, file=name, cases=(case,))
    description = result.recording.description
    texts = "\n".join(each.explained() for each in result.differences)
    problem = (
        JunitProblem(kind="failure", type="differs", message=str(result.difference), text=texts) if texts else None
    )
    case = JunitCase(name=Path(name).stem, classname=class_name(name), time_s=result.duration_s, problem=problem)
    properties = {
        "run": description.run,
        "behavior": description.behavior,
        "document_sha256": description.document,
        "seed": str(description.seed),
        "clock": description.clock,
        "events": str(result.compared),
    }
    return JunitSuite(name=description.behavior, file=name, cases=(case,), properties=properties)
