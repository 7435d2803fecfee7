"""The runs that are shrunk for a page: one at a time, followed until its process has answered or has ended."""

from __future__ import annotations

import asyncio
from pathlib import Path

import msgspec
import pytest

from engine.errors import ControlError, RobotError
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.shrinking import ShrinkProgress, Shrunk
from engine.sweep_library import shrinkings
from engine.sweep_library.shrink_view import Shrinking, ShrunkTrial
from engine.sweep_library.shrinkings import Shrinkings
from engine.sweep_library.sweep_files import NoSuchSweep
from engine.sweep_library.sweep_requests import Answered, Refused, ShrinkProceeding, SweepAnswer, SweepRequest

ID = "sweep.yaml"
PROGRESS = ShrinkProgress(runs=3, most_runs=200, step="round", changed=["parameters.luck"])
RUN = Configuration(number=4, seed=1, values={"parameters.luck": 0.9})
FOUND = ShrunkTrial(
    subject="f00",
    failing=RUN,
    shrunk=Shrunk(
        result=TrialResult(configuration=RUN, status="errored"),
        changed={"parameters.luck": (0.0, 0.9)},
        runs=7,
        passes={"parameters.luck": 0.8},
    ),
)


class ScriptedProcess:
    """A sweep process that answers what the test puts into it; an error ends it."""

    def __init__(self) -> None:
        self.answers: asyncio.Queue[SweepAnswer | RobotError] = asyncio.Queue()
        self.asked: list[SweepRequest] = []
        self.interrupts = 0
        self.is_closed = False

    async def start(self, _project: Path) -> ScriptedProcess:
        """Stands for the start of one."""
        return self

    async def send(self, request: SweepRequest) -> None:
        """Keep a request."""
        self.asked.append(request)

    async def receive(self, *, limit_s: float | None) -> SweepAnswer:
        """Return the next answer of the test."""
        async with asyncio.timeout(limit_s):
            answer = await self.answers.get()
        if isinstance(answer, RobotError):
            raise answer
        return answer

    def interrupt(self) -> None:
        """Count it."""
        self.interrupts += 1

    def close(self) -> None:
        """Note it."""
        self.is_closed = True


@pytest.fixture
def process(monkeypatch: pytest.MonkeyPatch) -> ScriptedProcess:
    """The process of all that is shrunk in the test."""
    scripted = ScriptedProcess()
    monkeypatch.setattr(shrinkings, "SweepProcessLink", scripted)
    return scripted


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A folder with a document that is a sweep."""
    (tmp_path / ID).write_text("flexcell: 1\nbehavior: luck.yaml\n")
    return tmp_path


async def ended(known: Shrinkings) -> Shrinking:
    """Wait for its end."""
    while (now := known.of(ID, 4)).status != "idle":  # noqa: ASYNC110 - untold
        await asyncio.sleep(0)
    return now


async def test_progress_is_reported_and_what_was_found_is_kept(project: Path, process: ScriptedProcess) -> None:
    known = Shrinkings(project)
    assert known.of(ID, 4) == Shrinking()
    await known.start(ID, 4, same="cause")
    process.answers.put_nowait(ShrinkProceeding(progress=PROGRESS))
    while known.of(ID, 4).progress is None:  # noqa: ASYNC110 - untold
        await asyncio.sleep(0)
    assert known.of(ID, 4) == Shrinking(status="running", progress=PROGRESS)
    process.answers.put_nowait(Answered(body=msgspec.Raw(msgspec.json.encode(FOUND))))
    assert (await ended(known)).found == msgspec.convert(msgspec.to_builtins(FOUND), ShrunkTrial)
    assert process.is_closed
    known.note_case(ID, 4, "tests/cases/a.yaml")
    assert known.of(ID, 4).saved_as == "tests/cases/a.yaml"


async def test_one_run_is_shrunk_at_a_time_and_stopped_once(project: Path, process: ScriptedProcess) -> None:
    known = Shrinkings(project)
    with pytest.raises(ControlError, match="not being shrunk"):
        known.stop(ID, 4)
    await known.start(ID, 4, same="outcome")
    with pytest.raises(ControlError, match="a run is being shrunk already"):
        await known.start(ID, 5, same="outcome")
    known.stop(ID, 4)
    known.stop(ID, 4)
    assert (known.of(ID, 4).status, process.interrupts, len(process.asked)) == ("stopping", 1, 1)
    process.answers.put_nowait(Answered(body=msgspec.Raw(msgspec.json.encode(FOUND))))
    assert (await ended(known)).found is not None
    await known.start(ID, 5, same="outcome")
    process.answers.put_nowait(RobotError("gone"))
    await known.close()


@pytest.mark.parametrize(
    "answer",
    [RobotError("the process has ended"), Refused(kind="state", words=("the process has ended", "", ""))],
)
async def test_why_nothing_was_found_is_reported(
    project: Path, process: ScriptedProcess, answer: SweepAnswer | RobotError
) -> None:
    known = Shrinkings(project)
    await known.start(ID, 4, same="outcome")
    process.answers.put_nowait(answer)
    assert await ended(known) == Shrinking(problem="the process has ended")
    await known.close()


async def test_no_process_is_started_for_what_is_no_sweep(project: Path, process: ScriptedProcess) -> None:
    with pytest.raises(NoSuchSweep):
        await Shrinkings(project).start("gone.yaml", 4, same="outcome")
    assert process.asked == []
