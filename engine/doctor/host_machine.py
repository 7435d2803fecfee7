"""How the machine is for what flexcell does on it: cores, punctuality, real-time rights, graphics, serial devices."""

from __future__ import annotations

import os
import resource
import statistics
import sys
import time
from collections.abc import Iterator
from ctypes.util import find_library
from pathlib import Path

from engine.doctor.examination import Examination

_GROUP = "machine"
_CORES = 2
_LATE_S = 0.002
_SLEEP_S, _SLEEPS = 0.001, 200
_REAL_TIME = Path("/sys/kernel/realtime")
_SERIAL = ("ttyUSB*", "ttyACM*")


def machine() -> Iterator[Examination]:
    """Yield how the machine is; takes about 0.3 s."""
    yield _cores()
    yield _punctuality()
    yield _real_time()
    yield _graphics()
    yield from _serial_devices(Path("/dev"))


def _cores() -> Examination:
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    load = os.getloadavg()[0]
    few = cores < _CORES
    advice = "a cell with its dashboard needs two cores" if few else ""
    if load > cores:
        advice = advice or "other programs need the cores too: motions in real time may be late"
    return Examination(
        group=_GROUP,
        subject="cores",
        condition="note" if advice else "ok",
        state=f"{cores}, load {load:.1f}",
        advice=advice,
    )


def _punctuality() -> Examination:
    late_s = sorted(_lateness_s() for _ in range(_SLEEPS))
    worst_s = late_s[round(0.99 * (_SLEEPS - 1))]
    is_late = worst_s > _LATE_S
    return Examination(
        group=_GROUP,
        subject="punctuality",
        condition="note" if is_late else "ok",
        state=f"a sleep of 1 ms ends {1e3 * statistics.median(late_s):.2f} ms late, 99 % within {1e3 * worst_s:.2f} ms",
        advice="real arms want a machine with less beside it, and real-time rights" if is_late else "",
    )


def _lateness_s() -> float:
    started_s = time.perf_counter()
    time.sleep(_SLEEP_S)
    return time.perf_counter() - started_s - _SLEEP_S


def _real_time() -> Examination:
    if not sys.platform.startswith("linux"):
        return Examination(group=_GROUP, subject="real time", condition="note", state="not on this system")
    priority = resource.getrlimit(resource.RLIMIT_RTPRIO)[0]
    may = os.geteuid() == 0 or priority > 0
    kernel = _REAL_TIME.exists() and _REAL_TIME.read_text(encoding="ascii").strip() == "1"
    return Examination(
        group=_GROUP,
        subject="real time",
        condition="ok" if may and kernel else "note",
        state=f"{'a' if kernel else 'no'} real-time kernel, {'may' if may else 'may not'} use real-time priorities",
        advice="" if may and kernel else "needed for a Franka arm only: docs/how-to/connect-a-franka.md",
    )


def _graphics() -> Examination:
    found = next((name for name in ("EGL", "OSMesa") if find_library(name)), "")
    return Examination(
        group=_GROUP,
        subject="graphics",
        condition="ok" if found else "note",
        state=f"{found}: images of simulated cameras are drawn" if found else "images of cameras are computed by rays",
        advice="" if found else "faster with EGL: on Debian `apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri`",
    )


def _serial_devices(folder: Path) -> Iterator[Examination]:
    for device in sorted(path for pattern in _SERIAL for path in folder.glob(pattern)):
        may = os.access(device, os.R_OK | os.W_OK)
        yield Examination(
            group=_GROUP,
            subject="serial device",
            condition="ok" if may else "note",
            state=str(device) if may else f"{device} may not be used by this user",
            advice="" if may else "on Debian: `adduser USER dialout`, and log in again",
        )
