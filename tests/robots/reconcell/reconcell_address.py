"""A loopback address of its own for each test: the ports of the interface are fixed."""

from __future__ import annotations

import itertools
import os

_numbers = itertools.count(1)


def own_address() -> str:
    """Return a loopback address that no other test has."""
    process = os.getpid()
    return f"127.{192 + (process >> 8) % 32}.{process % 256}.{next(_numbers) % 254 + 1}"
