"""How good the tests are: puts small mistakes into a package, one at a time, and counts those that no test notices.

    python -m benchmarks.mutants engine/bus --tests tests/engine/bus --tests tests/engine/faults
    python -m benchmarks.mutants robots/motion --sample 300 --json report.json
    python -m benchmarks.mutants robots/motion --again report.json     # only those that had survived

The tests are collected once. A first child process notes which lines each test runs. Then each mutant gets a child of
its own, in which the functions of the package that are already imported get the code with the mistake, and the tests
that run its line are run, quickest first, until one fails. Mistakes in code that runs at import, and in processes that
tests start, are not made.
"""

from __future__ import annotations

import argparse
import gc
import json
import math
import os
import random
import select
import signal
import sys
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import Any

import pytest
from _pytest.runner import runtestprotocol
from hypothesis import Phase, settings

from benchmarks.mutant_operators import Mutant, mutants_of, mutated

ROOT = Path(__file__).resolve().parents[1]
KILLED, SURVIVED, HUNG, NO_TEST = "killed", "survived", "hung", "no test"
_OPTIONS = ("-q", "-p", "no:randomly", "-p", "no:cacheprovider", "-W", "ignore::pytest.PytestAssertRewriteWarning")
_PATIENCE_S = 5
"""Beside five times what a test took with tracing: then it hangs, which counts as noticed."""


class MutantRun:
    """Plugin of pytest that runs mutants in place of the tests."""

    def __init__(self, mutants: Sequence[Mutant], *, jobs: int) -> None:
        self._mutants = mutants
        self._jobs = jobs
        self.verdicts: dict[Mutant, str] = {}

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Judge each mutant."""
        files = {str(ROOT / mutant.file) for mutant in self._mutants}
        lines, took_s = _traced(session.items, files)
        gc.unfreeze()
        functions = _functions(files)
        running: dict[int, tuple[Mutant, int]] = {}
        waiting = list(reversed(self._mutants))
        while waiting or running:
            while waiting and len(running) < self._jobs:
                mutant = waiting.pop()
                chosen = sorted(_tests_of(mutant, lines), key=lambda index: took_s[index])
                if not chosen:
                    self.verdicts[mutant] = NO_TEST
                    sys.stdout.write(f"{NO_TEST}: {mutant}\n")
                    continue
                tests = [(session.items[index], took_s[index]) for index in chosen]
                pid = _fork(mutant, tests, functions)
                running[os.pidfd_open(pid)] = (mutant, pid)
            self._collect(running)
        return True

    def _collect(self, running: dict[int, tuple[Mutant, int]]) -> None:
        """Wait for one of the children."""
        for handle in select.select(list(running), [], [])[0] if running else ():
            mutant, pid = running.pop(handle)
            os.close(handle)
            ended = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
            if ended < 0:
                # What the tests had started.
                with suppress(ProcessLookupError):
                    os.killpg(pid, signal.SIGKILL)
            self.verdicts[mutant] = HUNG if ended < 0 else KILLED if ended else SURVIVED
            if self.verdicts[mutant] == SURVIVED:
                sys.stdout.write(f"{len(self.verdicts)} of {len(self._mutants)} done; {SURVIVED}: {mutant}\n")
                sys.stdout.flush()


def _tests_of(mutant: Mutant, lines: Sequence[set[tuple[str, int]]]) -> list[int]:
    """Return the tests that run a line of a mutant, or else of the function around it."""
    file = str(ROOT / mutant.file)
    for first, last in ((mutant.line, mutant.last_line), mutant.function):
        lines_of_move = {(file, line) for line in range(first, last + 1)}
        chosen = [index for index, seen in enumerate(lines) if not lines_of_move.isdisjoint(seen)]
        if chosen:
            return chosen
    return []


def _traced(items: Sequence[pytest.Item], files: set[str]) -> tuple[list[set[tuple[str, int]]], list[float]]:
    """Run all tests in a child; return the lines that each runs in these files, and its duration in s."""
    reading, writing = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(reading)
        _silence()
        with os.fdopen(writing, "w") as report:
            for seen, took_s, failed in _traced_one_by_one(items, files):
                report.write(json.dumps([sorted(seen), took_s, failed]) + "\n")
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as report:
        rows = [json.loads(line) for line in report]
    os.waitpid(pid, 0)
    broken = [item.nodeid for item, row in zip(items, rows, strict=True) if row[2]]
    if broken:
        raise pytest.UsageError(f"these tests fail without any mutant: {broken}")
    return [{(file, line) for file, line in row[0]} for row in rows], [row[1] for row in rows]


def _traced_one_by_one(
    items: Sequence[pytest.Item], files: set[str]
) -> Iterator[tuple[set[tuple[str, int]], float, bool]]:
    seen: set[tuple[str, int]] = set()

    def on_line(frame: FrameType, _event: str, _argument: object) -> Any:
        seen.add((frame.f_code.co_filename, frame.f_lineno))
        return on_line

    def on_call(frame: FrameType, _event: str, _argument: object) -> Any:
        return on_line if frame.f_code.co_filename in files else None

    for item, following in zip(items, [*items[1:], None], strict=True):
        seen.clear()
        start_s = time.monotonic()
        threading.settrace(on_call)
        sys.settrace(on_call)
        failed = _fails(item, following)
        sys.settrace(None)
        yield set(seen), time.monotonic() - start_s, failed


def _fails(item: pytest.Item, following: pytest.Item | None) -> bool:
    return any(report.failed for report in runtestprotocol(item, log=False, nextitem=following))


def _fork(
    mutant: Mutant,
    tests: Sequence[tuple[pytest.Item, float]],
    functions: dict[tuple[str, str, int], list[FunctionType]],
) -> int:
    """Start a child that exits with 1 as soon as a test notices the mutant, and is ended by a test that hangs."""
    pid = os.fork()
    if pid:
        return pid
    os.setsid()
    _silence()
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    _apply(mutant, functions)
    following = [item for item, _ in tests[1:]]
    for (item, took_s), next_item in zip(tests, [*following, None], strict=True):
        signal.alarm(_PATIENCE_S + math.ceil(5.0 * took_s))
        if _fails(item, next_item):
            os._exit(1)
    os._exit(0)


def _silence() -> None:
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)


def _apply(mutant: Mutant, functions: dict[tuple[str, str, int], list[FunctionType]]) -> None:
    """Give the imported functions the code with the mistake; code that does not fit counts as noticed."""
    file = str(ROOT / mutant.file)
    try:
        for code in _outermost(compile(mutated(ROOT / mutant.file, mutant.number), file, "exec")):
            if mutant.function[0] <= code.co_firstlineno + _decorators(code, mutant) <= mutant.function[1]:
                for function in functions.get((file, code.co_qualname, code.co_firstlineno), ()):
                    function.__code__ = code
    except (SyntaxError, ValueError):
        os._exit(1)


def _decorators(code: CodeType, mutant: Mutant) -> int:
    """Return how far the line of `def` lies below the first decorator, with which code begins."""
    lies_above = code.co_firstlineno < mutant.function[0] <= min(line for *_, line in code.co_lines() if line) + 1
    return mutant.function[0] - code.co_firstlineno if lies_above else 0


def _outermost(code: CodeType) -> Iterator[CodeType]:
    """Yield the code of functions that lie in no other function."""
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            if constant.co_flags & 2:  # CO_NEWLOCALS: a function; the body of a class has it not
                yield constant
            else:
                yield from _outermost(constant)


def _functions(files: set[str]) -> dict[tuple[str, str, int], list[FunctionType]]:
    found: dict[tuple[str, str, int], list[FunctionType]] = defaultdict(list)
    for each in gc.get_objects():
        if isinstance(each, FunctionType) and each.__code__.co_filename in files:
            code = each.__code__
            found[code.co_filename, code.co_qualname, code.co_firstlineno].append(each)
    return found


def sampled(package: Path, count: int | None, seed: int) -> list[Mutant]:
    """Return the mutants of a file or of all files in a folder, or so many of them, chosen by the seed."""
    files = sorted((ROOT / package).rglob("*.py")) if (ROOT / package).is_dir() else [ROOT / package]
    found = [mutant for file in files for mutant in mutants_of(file.relative_to(ROOT))]
    if count is None or count >= len(found):
        return found
    return sorted(random.Random(seed).sample(found, count), key=lambda each: (each.file, each.number))


def main() -> None:
    """Run the mutants of a package against its tests; print the figures and the survivors."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("package", type=Path, help="folder or file of source, from the root of the repository")
    parser.add_argument("--tests", action="append", help="folder or file of tests; default: the mirrored folder")
    parser.add_argument("--sample", type=int, help="so many mutants instead of all")
    parser.add_argument("--seed", type=int, default=0, help="chooses the sample")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--json", type=Path, help="write every verdict to this file")
    parser.add_argument("--again", type=Path, help="run only those that survived in this file")
    asked = parser.parse_args()
    os.chdir(ROOT)
    mutants = sampled(asked.package, asked.sample, asked.seed)
    if asked.again:
        before = json.loads(asked.again.read_text(encoding="utf-8"))
        mutants = [mutant for mutant in mutants if before.get(str(mutant)) in (SURVIVED, NO_TEST)]
    settings.register_profile("mutants", derandomize=True, database=None, phases=(Phase.explicit, Phase.generate))
    settings.load_profile("mutants")
    run = MutantRun(mutants, jobs=asked.jobs)
    tests = asked.tests or [f"tests/{asked.package}"]
    ended = pytest.main([*_OPTIONS, *tests], plugins=[run])
    if ended not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED) or not run.verdicts:
        sys.exit(1)
    if asked.json:
        asked.json.write_text(json.dumps({str(m): v for m, v in run.verdicts.items()}, indent=1), encoding="utf-8")
    counts = Counter(run.verdicts.values())
    missed = counts[SURVIVED] + counts[NO_TEST]
    sys.stdout.write(f"\n{asked.package}: {len(mutants)} mutants, {len(mutants) - missed} noticed, {dict(counts)}\n")


if __name__ == "__main__":
    main()
