"""The packages that draw pictures, imported when they are needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from engine.errors import FlexcellError

_INSTALL = "pip install 'flexcell[picture]'"


def picture_package(module: str, what: str) -> Any:
    """Return a module of a package of the extra `picture`; `what` says what it is for.

    Raises:
        FlexcellError: it is not installed.
    """
    try:
        return import_module(module)
    except ImportError as error:
        raise FlexcellError(f"{what}, `{module.partition('.')[0]}`, is not installed", hint=_INSTALL) from error
