"""Contains the errors of code of others inside a run: each says whose it was and where."""

from __future__ import annotations

import asyncio
from collections.abc import Generator
from contextlib import contextmanager

from engine.errors import FlexcellError, StateError


@contextmanager
def contain_errors(what: str, *, where: str) -> Generator[None]:
    """Raise StateError, naming `what` and `where`, in place of anything that is raised inside, SystemExit too.

    Errors of flexcell and what ends a task or a generator pass as they are.
    """
    try:
        yield
    except (FlexcellError, asyncio.CancelledError, GeneratorExit):
        raise
    except BaseException as error:
        raise StateError(f"{what} raised {type(error).__name__}: {error}", where=where) from error
