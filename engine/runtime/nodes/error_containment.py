"""Contains errors of user code inside a run: each error states its origin and position."""

from __future__ import annotations

import asyncio
from collections.abc import Generator
from contextlib import contextmanager

from engine.errors import FlexcellError, StateError


@contextmanager
def contain_errors(what: str, *, where: str) -> Generator[None]:
    """Convert any exception raised inside, SystemExit included, to a StateError that names `what` and `where`.

    Errors of flexcell, CancelledError and GeneratorExit pass unchanged.
    """
    try:
        yield
    except (FlexcellError, asyncio.CancelledError, GeneratorExit):
        raise
    except BaseException as error:
        raise StateError(f"{what} raised {type(error).__name__}: {error}", where=where) from error
