"""Compares the engine with others at the same work: `benchmarks/engine.py [--quick] [--rounds N] [--json FILE]`."""

from __future__ import annotations

from benchmarks.benchmark_cli import run_script
from benchmarks.comparison import Columns, Result, Row, Table

PACKAGES = ("flexcell", "py_trees", "transitions", "python-statemachine", "sismic")
_SMACH_LIKE = "SMACH-like (threads)"


def _cpu_us(result: Result) -> float:
    return result.cpu_us


_RATES: Columns = {
    "µs CPU each": lambda r: f"{r.cpu_us:.3g}",
    "per CPU-s": lambda r: f"{1e6 / r.cpu_us:,.0f}",
    "per s of wall time": lambda r: f"{1e6 / r.wall_us:,.0f}",
}
_LATENCIES: Columns = {
    "p50 ms": lambda r: f"{r.latency_ms(0.5):.3f}",
    "p99 ms": lambda r: f"{r.latency_ms(0.99):.3f}",
}
_ONCE: Columns = {
    "CPU ms": lambda r: f"{r.cpu_us * r.samples[0].units / 1e3:,.0f}",
    "wall ms": lambda r: f"{r.wall_us * r.samples[0].units / 1e3:,.0f}",
}

CHAIN = Table(
    "Chain of 1000 states: transitions",
    rows=(
        Row("flexcell", "flexcell:chain", (1000,), (20,)),
        Row("flexcell, watched", "flexcell:watched_chain", (1000,), (20,), "every event is made and kept in a list"),
        Row("flexcell, journaled", "flexcell:journaled_chain", (1000,), (20,), "every event on the disk at the end"),
        Row("flexcell, behavior tree", "flexcell:tree_chain", (1000,), (20,), "a sequence of states"),
        Row("plain asyncio (floor)", "plain_asyncio:chain", (1000,), (20,), "awaits of an empty coroutine"),
        Row("py_trees", "behavior_tree:chain", (1000,), (20,), "a sequence inside one tick"),
        Row(_SMACH_LIKE, "smach_like:chain", (1000,), (20,)),
        Row("transitions", "transitions_machine:chain", (1000,), (20,)),
        Row("transitions, hierarchical", "transitions_machine:hierarchical_chain", (1000,), (20,)),
        Row("python-statemachine", "python_statemachine:chain", (1000,), (20,)),
        Row("sismic", "sismic_chart:chain", (1000,), (20,)),
    ),
    columns=_RATES,
    ratio=_cpu_us,
)
BRANCHES = Table(
    "100 parallel branches: transitions in all of them",
    rows=(
        Row("flexcell", "flexcell:branches", (100, 100), (3, 5)),
        Row("plain asyncio (floor)", "plain_asyncio:branches", (100, 100), (3, 5)),
        Row("py_trees", "behavior_tree:branches", (100, 100), (3, 5), "a parallel of sequences inside one tick"),
        Row(_SMACH_LIKE, "smach_like:branches", (100, 100), (3, 5), "a thread for each branch"),
        Row("transitions, hierarchical", "transitions_machine:branches", (100, 5), (3, 5), "5 steps"),
        Row("python-statemachine", "python_statemachine:branches", (100, 1), (3, 2), "1 step"),
        Row("sismic", "sismic_chart:branches", (100, 10), (3, 5), "10 steps"),
    ),
    columns=_RATES,
    ratio=_cpu_us,
    note="100 steps in each branch where nothing else is said",
)
TICKS = Table(
    "100 parallel children, each woken 100 times",
    rows=(
        Row("flexcell", "flexcell:ticks", (100, 100), (3, 5)),
        Row("flexcell, behavior tree", "flexcell:tree_ticks", (100, 100), (3, 5), "wake-ups of leaves in a parallel"),
        Row("plain asyncio (floor)", "plain_asyncio:ticks", (100, 100), (3, 5)),
        Row("py_trees", "behavior_tree:ticks", (100, 100), (3, 5), "ticks of running leaves"),
    ),
    columns=_RATES,
    ratio=_cpu_us,
)
REACTION = Table(
    "Reaction: event posted by another thread → next state entered",
    rows=(
        Row("flexcell", "flexcell:reaction", (200,), (3,)),
        Row("plain asyncio (floor)", "plain_asyncio:reaction", (200,), (3,)),
        Row("py_trees", "behavior_tree:reaction", (200,), (3,), "ticked every 10 ms"),
        Row(_SMACH_LIKE, "smach_like:reaction", (200,), (3,), "its thread blocks on a queue"),
        Row("transitions", "transitions_machine:reaction", (200,), (3,), "a thread of ours blocks on a queue"),
        Row("python-statemachine", "python_statemachine:reaction", (200,), (3,), "a thread of ours blocks on a queue"),
        Row("sismic", "sismic_chart:reaction", (50,), (3,), "its runner looks every 100 ms"),
    ),
    columns=_LATENCIES,
    ratio=lambda r: r.latency_ms(0.5),
)
IDLE = Table(
    "Idle: 100 children that wait",
    rows=(
        Row("flexcell", "flexcell:idle", (100, 2000), (3, 100)),
        Row("plain asyncio (floor)", "plain_asyncio:idle", (100, 2000), (3, 100)),
        Row("py_trees", "behavior_tree:idle", (100, 2000), (3, 100), "ticked every 10 ms"),
        Row(_SMACH_LIKE, "smach_like:idle", (100, 2000), (3, 100), "100 blocked threads"),
        Row("transitions", "transitions_machine:idle", (100, 2000), (3, 100), "has no runner of its own"),
        Row("sismic", "sismic_chart:idle", (2000,), (100,), "one waiting state, its runner looks every 100 ms"),
    ),
    columns={
        "CPU-ms per s": lambda r: f"{r.busy_ms_per_s:.2f}",
        "% of a core": lambda r: f"{r.busy_ms_per_s / 10:.3f}",
    },
    ratio=lambda r: r.busy_ms_per_s,
)
LOAD = Table(
    "Load, check and plan a document",
    rows=(
        Row("10 states", "flexcell:load", (10,), (2,)),
        Row("100 states", "flexcell:load", (100,), (4,)),
        Row("1,000 states", "flexcell:load", (1000,), (8,)),
        Row("10,000 states", "flexcell:load", (10_000,), (16,)),
    ),
    columns={"µs CPU per state": lambda r: f"{r.cpu_us:.3g}", **_ONCE},
    ratio=lambda r: r.cpu_us * r.samples[0].units,
)
SCALING = Table(
    "Scaling: transitions in a chain of so many states",
    rows=tuple(
        Row(f"{name}, {states:,} states", function, (states,), (4,))
        for name, function in (
            ("flexcell", "flexcell:chain"),
            ("flexcell, journaled", "flexcell:journaled_chain"),
            ("flexcell, resumed", "flexcell:resumed_chain"),
            ("py_trees", "behavior_tree:chain"),
            ("transitions", "transitions_machine:chain"),
        )
        for states in ((10, 100, 1000, 10_000) if name != "transitions" else (10, 100, 1000))
    ),
    columns=_RATES,
    ratio=_cpu_us,
)
IMPORT = Table(
    "Import",
    rows=(
        Row("flexcell", "importing:flexcell", (), (), "all that loading, planning and running a behavior needs"),
        Row("flexcell with its check", "importing:flexcell_checked", (), ()),
        Row("flexcell command", "importing:flexcell_command", (), ()),
        Row("plain asyncio (floor)", "importing:asyncio", (), ()),
        Row("py_trees", "importing:py_trees", (), ()),
        Row("transitions", "importing:transitions", (), ()),
        Row("python-statemachine", "importing:statemachine", (), ()),
        Row("sismic", "importing:sismic", (), ()),
    ),
    columns=_ONCE,
    ratio=_cpu_us,
)
TABLES = (CHAIN, BRANCHES, TICKS, REACTION, IDLE, LOAD, SCALING, IMPORT)

ELSEWHERE = """\
### Measured elsewhere, not in this run

These engines cannot be installed from PyPI or the distribution used here (SMACH, YASMIN and
BehaviorTree.CPP come with ROS or a C++ build; RAFCON needs cairo and GTK headers to install). The
figures are from an earlier study on a machine of the same kind; compare ratios only.

|                              | chain µs a step | per CPU-s | child-ticks per CPU-s |     reaction p50 / p99 ms |
|------------------------------|----------------:|----------:|----------------------:|--------------------------:|
| BehaviorTree.CPP 4.10 (C++)  |             0.5 |    1.87 M |                 7.5 M | 5.0 / 18, woken 0.06 / 16 |
| YASMIN 6.1 (C++ core)        |             9.8 |     102 k |        867 k, threads |               0.06 / 0.11 |
| SMACH, polling               |             7.1 |     141 k |        638 k, threads |                   24 / 50 |
| SMACH, waiting for an event  |             7.1 |     141 k |        638 k, threads |               0.11 / 0.16 |
| RAFCON core                  |            1256 |     0.8 k |                 179 k |             1.3 / 125–193 |
| py_trees 2.6, for comparison |             8.4 |     120 k |                 228 k |                  5.2 / 10 |
"""

if __name__ == "__main__":
    run_script("Engines side by side", TABLES, PACKAGES, closing=ELSEWHERE)
