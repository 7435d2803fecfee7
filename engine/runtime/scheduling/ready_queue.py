"""What an asyncio loop has ready to run: of no public name, so it is named in one place only."""

from __future__ import annotations

from asyncio import AbstractEventLoop, Handle
from collections import deque
from typing import cast


def ready_queue(loop: AbstractEventLoop) -> deque[Handle]:
    """Return the loop's own queue, first that which runs next."""
    return cast("deque[Handle]", getattr(loop, "_ready"))  # noqa: B009 - private, and typed nowhere
