"""Numbers shared between processes: never torn, readable after the writer died in mid-write."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from robots.port.shared_file import new_shared_file
from robots.port.shared_numbers import SharedNumbers

ROOT = Path(__file__).parents[4]


WRITER = """
import sys
import numpy as np
from robots.port.shared_numbers import SharedNumbers
shared = SharedNumbers(int(sys.argv[1]), 20000)
value = 0.0
while True:
    value += 1.0
    shared.write(np.full(20000, value))
"""


def test_a_reader_never_sees_half_of_a_write_of_another_process() -> None:
    descriptor = new_shared_file("numbers")
    reader = SharedNumbers(descriptor, 20000)
    writer = subprocess.Popen([sys.executable, "-c", WRITER, str(descriptor)], pass_fds=(descriptor,), cwd=ROOT)
    os.close(descriptor)
    try:
        while reader.read()[0] == 0.0:
            os.sched_yield()
        first = last = reader.read()
        reads = torn = 0
        # However seldom the writer gets its turn, what is read has changed under the reader in the end.
        while reads < 1000 or last[0] < first[0] + 10.0:
            last = reader.read()
            reads += 1
            torn += int(last.min() != last.max())
    finally:
        writer.kill()
        writer.wait()
    assert torn == 0
    reader.close()


@given(cut=st.integers(0, 3), writes=st.integers(1, 5))
def test_a_writer_that_stops_anywhere_in_a_write_leaves_the_numbers_before_it(cut: int, writes: int) -> None:
    descriptor = new_shared_file("numbers")
    shared = SharedNumbers(descriptor, 3)
    for value in range(1, writes + 1):
        shared.write(np.full(3, float(value)))
    reader = SharedNumbers(descriptor, 3)
    _write_up_to(descriptor, cut, count=writes + 1)
    assert reader.read().tolist() == [float(writes)] * 3
    for each in (shared, reader):
        each.close()
    os.close(descriptor)


def _write_up_to(descriptor: int, numbers: int, *, count: int) -> None:
    """Do what a writer of three numbers does until it is stopped before it has raised the count."""
    os.pwrite(descriptor, np.full(numbers, -1.0).tobytes(), 8 + 8 * 3 * (count % 2))
