"""What follows the start of a motion must not leave it running alone."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

from robots.port import Motion


@contextmanager
def canceled_by_errors(motion: Motion) -> Generator[None]:
    """Cancel a motion that the port has just started if what is to supervise it fails: no other cancel reaches it."""
    try:
        yield
    except BaseException:
        motion.cancel()
        raise
