"""What it costs to import a library, in a fresh process of which nothing else is counted."""

from __future__ import annotations

import importlib
import time

from benchmarks.sample import Sample, Stopwatch

_RUNNING = ("engine.document", "engine.runtime.plan", "engine.runtime.run", "engine.bus", "engine.journal")


def flexcell(watch: Stopwatch) -> Sample:
    """What loading, planning and running a behavior needs: documents, plan, run, bus, journal."""
    return _import(*_RUNNING)


def flexcell_checked(watch: Stopwatch) -> Sample:
    """The same, and the check."""
    return _import(*_RUNNING, "engine.check")


def flexcell_command(watch: Stopwatch) -> Sample:
    """What the `flexcell` command needs before it does anything."""
    return _import("engine.cli.main")


def py_trees(watch: Stopwatch) -> Sample:
    """py_trees."""
    return _import("py_trees")


def transitions(watch: Stopwatch) -> Sample:
    """transitions with its extensions."""
    return _import("transitions", "transitions.extensions")


def statemachine(watch: Stopwatch) -> Sample:
    """python-statemachine."""
    return _import("statemachine")


def sismic(watch: Stopwatch) -> Sample:
    """sismic with its YAML reader and interpreter."""
    return _import("sismic.io", "sismic.interpreter")


def asyncio(watch: Stopwatch) -> Sample:
    """asyncio alone."""
    return _import("asyncio")


def _import(*modules: str) -> Sample:
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    for module in modules:
        importlib.import_module(module)
    return Sample(1, time.process_time() - cpu_s, time.perf_counter() - wall_s)
