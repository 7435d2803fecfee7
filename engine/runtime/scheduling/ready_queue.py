"""The ready queue of an asyncio loop: a private attribute, accessed only here."""

from __future__ import annotations

from asyncio import AbstractEventLoop, Handle
from collections import deque
from typing import cast


def ready_queue(loop: AbstractEventLoop) -> deque[Handle]:
    """Return the queue of the loop, next handle first."""
    return cast("deque[Handle]", getattr(loop, "_ready"))  # noqa: B009 - private, and typed nowhere
