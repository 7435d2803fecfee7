"""CPU time, memory and threads of processes and of all that they started, from Linux' /proc."""

from __future__ import annotations

import os
import time
from pathlib import Path

_TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def cpu_now_s(pid: int) -> float:
    """Return the CPU seconds that a process has used, to the microsecond, without what it started."""
    # The clock of another process, as `clock_getcpuclockid` of Linux makes it.
    return time.clock_gettime((~pid << 3) | 2)


def cpu_s(*pids: int) -> float:
    """Return the CPU seconds that these processes have used, without what they started."""
    return sum(_ticks(pid) for pid in pids) / _TICKS_PER_S


def memory_mb(*pids: int) -> float:
    """Return the memory that these processes have in RAM, without what they started."""
    return sum(_status(pid, "VmRSS") for pid in pids) / 1e3


def threads(*pids: int) -> int:
    """Return how many threads these processes have, without what they started."""
    return sum(_status(pid, "Threads") for pid in pids)


def descendants(pid: int) -> tuple[int, ...]:
    """Return a process and all that it has started, directly or not, and that still run."""
    parents = {int(entry.name): _parent(int(entry.name)) for entry in Path("/proc").iterdir() if entry.name.isdigit()}
    found = [pid]
    for known in found:
        found.extend(child for child, parent in parents.items() if parent == known)
    return tuple(found)


def _parent(pid: int) -> int:
    fields = _stat(pid)
    return int(fields[1]) if fields else 0


def _ticks(pid: int) -> int:
    fields = _stat(pid)
    return int(fields[11]) + int(fields[12]) if fields else 0


def _status(pid: int, name: str) -> int:
    """Return a number of `/proc/<pid>/status`, 0 when the process has ended."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text(encoding="utf-8", errors="replace").splitlines()
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return next((int(line.split()[1]) for line in lines if line.startswith(f"{name}:")), 0)


def _stat(pid: int) -> list[str]:
    """Return the fields of a process after its name, none when it has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace").rsplit(")", 1)[1].split()
    except (FileNotFoundError, ProcessLookupError):
        return []
