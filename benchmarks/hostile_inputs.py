"""Hostile expressions and documents through check, editor and run: `benchmarks/hostile_inputs.py [--expressions N]`.

What a server does on worker threads is done there, what it does on the event loop is done there; meanwhile the
longest block of the loop, the memory and every error that is none of the project's own are measured. A block
counts in CPU time of the process, and the thread of the loop is scheduled first where the system permits it: else
other programs on the machine keep it from running while the worker goes on, which counts as a block and is none. The
text with the longest block is reported by its number; `--first` begins there. Exit code 1 where a bound is exceeded.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import os
import random
import resource
import sys
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, ClassVar

from benchmarks.hostile_documents import base_documents, expression_document, mutated_document
from engine.bus import SkillBus
from engine.check import check_behavior
from engine.clock import new_clock, run_virtual
from engine.document import Behavior, parse_behavior
from engine.editing.draft_cache import DraftCache
from engine.editing.edits.edit import SetParameter
from engine.editing.project_context import ProjectContext
from engine.errors import FlexcellError
from engine.host.thread_switch_interval import short_switch_interval
from engine.registry import load_states
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from engine.state import Context, Outcome, State

PROJECT = Path(__file__).resolve().parents[1]
MAX_BLOCK_MS = 50.0
MAX_MEMORY_MB = 200.0
_STOP_AFTER_S = 60.0
_AT_ONCE = 8
_PRIORITY = 1


class Take(State, frozen=True, kw_only=True):
    """Take any value and hand it on, at once."""

    state_name: ClassVar[str] = "hostile.Take"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    outputs: ClassVar[dict[str, Any]] = {"value": object}
    value: object = None

    async def run(self, ctx: Context) -> Outcome:
        """Hand it on."""
        return Outcome("done", {"value": self.value})


@dataclass
class ProbeStatistics:
    """What was measured of one way through the project."""

    name: str
    count: int = 0
    refused: int = 0
    block_cpu_ms: float = 0.0
    block_wall_ms: float = 0.0
    text: int = 0
    """The number of the text that is on its way, from 0."""
    worst_text: int = 0
    """The number of the text with the longest block."""
    errors: list[str] = field(default_factory=list[str])

    def row(self) -> str:
        """Return a row of the table."""
        blocks = f"{self.block_cpu_ms:.1f} | {self.block_wall_ms:.1f} | {self.worst_text}"
        return f"| {self.name} | {self.count:,} | {self.refused:,} | {blocks} | {len(self.errors)} |"

    def look(self, work: Callable[[], object]) -> Any:
        """Do something that may be refused; note what must not happen."""
        self.count += 1
        try:
            return work()
        except FlexcellError:
            self.refused += 1
        except Exception as error:
            # Whatever else comes out is a traceback for somebody; that is what is counted.
            self.errors.append(f"text {self.text}: {type(error).__name__}: {str(error)[:200]}")
        return None


class HostileInputProbe:
    """One pass of texts through check, editor and run."""

    def __init__(self, catalogue: Catalogue) -> None:
        self._catalogue = catalogue
        self._drafts = DraftCache()
        self._context = ProjectContext(catalogue, PROJECT / "behaviors", PROJECT)
        self._file = PROJECT / "behaviors" / "hostile.yaml"
        self.checking = ProbeStatistics("check, on a thread")
        self.editing = ProbeStatistics("draw, edit and check, on a thread")
        self.planning = ProbeStatistics("plan, on a thread")
        self.running = ProbeStatistics("run, on the loop")

    @property
    def probes(self) -> tuple[ProbeStatistics, ...]:
        """All four."""
        return (self.checking, self.editing, self.planning, self.running)

    def pass_through(self, texts: Iterator[tuple[int, str]]) -> None:
        """Take every text, with its number, through all of them."""
        while some := tuple(islice(texts, _AT_ONCE)):
            for number, plan in asyncio.run(self._prepared(some)):
                self._executed(number, plan)

    def _executed(self, number: int, plan: Plan) -> None:
        self.running.text = number
        self.running.look(lambda: run_virtual(self._run(plan)))

    async def _prepared(self, texts: Sequence[tuple[int, str]]) -> list[tuple[int, Plan]]:
        plans = [(number, await self._planned(number, text)) for number, text in texts]
        return [(number, plan) for number, plan in plans if plan is not None]

    async def _planned(self, number: int, text: str) -> Plan | None:
        self.checking.text = self.editing.text = self.planning.text = number
        behavior: Behavior | None = await _beside(self.checking, lambda: self._checked(text))
        await _beside(self.editing, lambda: self._edited(text))
        if behavior is None:
            return None
        return await _beside(self.planning, lambda: new_plan(behavior, self._catalogue))

    def _checked(self, text: str) -> Behavior:
        behavior = parse_behavior(text, file=self._file)
        check_behavior(behavior, self._catalogue)
        return behavior

    def _edited(self, text: str) -> None:
        self._drafts.draw(text, file=self._file, context=self._context)
        edit = SetParameter(path="root/take", name="value", value="${a + a}")
        done = self._drafts.edit(text, [edit], file=self._file, context=self._context)
        self._drafts.examine(done.text, file=self._file, context=self._context)

    async def _run(self, plan: Plan) -> RunResult:
        with _timed_callbacks(self.running):
            run = Run(plan, run="hostile", bus=SkillBus(new_clock()))
            asyncio.get_running_loop().call_later(_STOP_AFTER_S, run.stop, "long enough")
            return await run.execute()


async def _beside(statistics: ProbeStatistics, work: Callable[[], object]) -> Any:
    """Work on a thread while the loop ticks; note the longest time between two ticks."""
    working = asyncio.get_running_loop().run_in_executor(None, statistics.look, work)
    # Only now: the worker has the ordinary schedule.
    with scheduled_first():
        while not working.done():
            wall_s, cpu_s = time.perf_counter(), time.process_time()
            await asyncio.sleep(0.001)
            _note(statistics, time.perf_counter() - wall_s, time.process_time() - cpu_s)
    return await working


@contextmanager
def scheduled_first() -> Generator[bool]:
    """Schedule this thread before all others inside; false, and the ordinary schedule, where that is not permitted."""
    policy, priority = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    except OSError:
        yield False
        return
    try:
        yield True
    finally:
        os.sched_setscheduler(0, policy, priority)


class _timed_callbacks:  # noqa: N801
    """Times every callback that the loops of this process run inside."""

    def __init__(self, statistics: ProbeStatistics) -> None:
        self._statistics = statistics
        self._run = asyncio.Handle._run  # pyright: ignore[reportPrivateUsage, reportUnknownMemberType]

    def __enter__(self) -> None:
        statistics, run = self._statistics, self._run

        def timed(handle: asyncio.Handle) -> None:
            wall_s, cpu_s = time.perf_counter(), time.process_time()
            run(handle)
            _note(statistics, time.perf_counter() - wall_s, time.process_time() - cpu_s)

        asyncio.Handle._run = timed  # type: ignore[method-assign] # pyright: ignore[reportPrivateUsage, reportAttributeAccessIssue]

    def __exit__(self, *_: object) -> None:
        asyncio.Handle._run = self._run  # type: ignore[method-assign] # pyright: ignore[reportPrivateUsage, reportAttributeAccessIssue]


def _note(statistics: ProbeStatistics, wall_s: float, cpu_s: float) -> None:
    statistics.block_wall_ms = max(statistics.block_wall_ms, 1e3 * wall_s)
    if 1e3 * cpu_s > statistics.block_cpu_ms:
        statistics.block_cpu_ms, statistics.worst_text = 1e3 * cpu_s, statistics.text


def hostile_catalogue() -> Catalogue:
    """Return the states that documents may name."""
    return {**load_states(), "hostile.Take": Take}


def peak_memory_mb() -> float:
    """Return the most memory that this process has had."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def _report(title: str, made: HostileInputProbe, memory_mb: float) -> bool:
    print(f"### {title}\n")
    print("| | texts | refused | longest block, CPU ms | wall ms | text | tracebacks |\n|---|---|---|---|---|---|---|")
    for statistics in made.probes:
        print(statistics.row())
        for error in statistics.errors[:5]:
            print(f"    {error}")
    print(f"\nMemory: {memory_mb:.0f} MB more than before.\n", flush=True)
    kept = all(statistics.block_cpu_ms <= MAX_BLOCK_MS and not statistics.errors for statistics in made.probes)
    return kept and memory_mb <= MAX_MEMORY_MB


def main() -> int:
    """Run the script."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--expressions", type=int, default=10_000, help="texts with hostile expressions")
    parser.add_argument("--documents", type=int, default=10_000, help="mutated documents")
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--first", type=int, default=0, help="number of the first text that is taken, not only made")
    options = parser.parse_args()
    catalogue = hostile_catalogue()
    bases = base_documents(PROJECT)
    HostileInputProbe(catalogue).pass_through(iter(((0, bases[-1]),)))
    # As `serve` and `run` do before anything moves, and `short_switch_interval` below.
    gc.collect()
    gc.freeze()
    before_mb = peak_memory_mb()
    kept: list[bool] = []
    for title, count, make in (
        ("Expressions and templates", options.expressions, expression_document),
        ("Mutated documents", options.documents, partial(mutated_document, bases=bases)),
    ):
        made = HostileInputProbe(catalogue)
        chance = random.Random(options.seed)
        texts = ((number, make(chance)) for number in range(count))
        with short_switch_interval():
            made.pass_through(islice(texts, options.first, None))
        kept.append(_report(f"{title}, {count:,}, seed {options.seed}", made, peak_memory_mb() - before_mb))
    with scheduled_first() as is_first:
        print(f"The loop is scheduled first: {'yes' if is_first else 'not permitted, other programs count'}.")
    print(f"Bounds: {MAX_BLOCK_MS:g} ms, {MAX_MEMORY_MB:g} MB, no traceback: {'kept' if all(kept) else 'EXCEEDED'}.")
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
