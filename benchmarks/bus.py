"""Measures the skill bus beside other channels: `benchmarks/bus.py [--quick] [--rounds N] [--json FILE]`."""

from __future__ import annotations

from benchmarks.benchmark_cli import run_script
from benchmarks.comparison import Columns, Result, Row, Table

PACKAGES = ("flexcell", "blinker", "pyee")
_CONTROL_HZ = 1000


def _cpu_us(result: Result) -> float:
    return result.cpu_us


_COSTS: Columns = {"µs CPU each": lambda r: f"{r.cpu_us:.3g}", "per CPU-s": lambda r: f"{1e6 / r.cpu_us:,.0f}"}


def _publish(subscribers: int) -> Table:
    given = (subscribers,)
    return Table(
        f"Publish a message to {subscribers} callback{'s' if subscribers != 1 else ''}",
        rows=(
            Row("flexcell", "bus_flexcell:publish", given, given),
            Row("plain function calls", "bus_peers:plain_calls", given, given),
            Row("blinker", "bus_peers:blinker", given, given),
            Row("pyee", "bus_peers:pyee", given, given),
        ),
        columns=_COSTS,
        ratio=_cpu_us,
    )


def _stream(subscribers: int) -> Table:
    given = (subscribers,)
    return Table(
        f"Publish a message to {subscribers} awaiting task{'s' if subscribers != 1 else ''}",
        rows=(
            Row("flexcell stream", "bus_flexcell:stream", given, given),
            Row("asyncio.Queue each", "bus_peers:queues", given, given),
        ),
        columns=_COSTS,
        ratio=_cpu_us,
    )


SKILLS = Table(
    "One exchange, nothing else going on",
    rows=(
        Row("service call", "bus_flexcell:call", (), ()),
        Row("plain await", "bus_peers:coroutine", (), (), "an empty coroutine: the floor of a service call"),
        Row("action round trip", "bus_flexcell:perform", (), (), "goal, lease, accept, one feedback, result"),
        Row("plain task", "bus_peers:task", (), (), "an empty task, started and awaited: the floor of an action"),
        Row("latest value", "bus_flexcell:latest", (), (), "topic looked up by name and type"),
        Row("plain dictionary", "bus_peers:attribute", (), ()),
        Row("lease and release", "bus_flexcell:lease", (), (), "an arm and its gripper"),
        Row("asyncio.Lock", "bus_peers:lock", (), (), "two of them"),
    ),
    columns=_COSTS,
    ratio=_cpu_us,
)
CONTROL = Table(
    "A new joint state at 1 kHz to 10 callbacks, message included",
    rows=(
        Row("flexcell", "bus_flexcell:joint_states", (10,), (10,)),
        Row("plain function calls", "bus_peers:plain_calls_new", (10,), (10,)),
    ),
    columns={**_COSTS, "% of a core at 1 kHz": lambda r: f"{r.cpu_us * _CONTROL_HZ / 1e6 * 100:.2f}"},
    ratio=_cpu_us,
)
THREADS = Table(
    "From another thread to an awaiting task",
    rows=(
        Row("flexcell", "bus_flexcell:across_threads", (200,), (3,)),
        Row("asyncio.Queue", "bus_peers:across_threads", (200,), (3,)),
    ),
    columns={
        "p50 ms": lambda r: f"{r.latency_ms(0.5):.3f}",
        "p99 ms": lambda r: f"{r.latency_ms(0.99):.3f}",
    },
    ratio=lambda r: r.latency_ms(0.5),
)
TABLES = (_publish(0), _publish(1), _publish(10), _stream(1), _stream(10), SKILLS, CONTROL, THREADS)

if __name__ == "__main__":
    run_script("The skill bus beside other channels", TABLES, PACKAGES)
