"""Loads a behavior built in a Python file, named as `FILE.py` or `FILE.py:NAME`."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Generator
from contextlib import contextmanager, suppress
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import ModuleType

from engine.cause_chain import cause_of, describe_cause
from engine.document.behavior import Behavior
from engine.errors import DocumentError, FlexcellError, Position
from engine.type_preparation import prepare_types
from engine.wording.suggestions import did_you_mean


def load_python_behavior(name: str) -> Behavior:
    """Run a Python file and return the behavior with a name at its top level.

    The file runs as a module named after it, with its folder importable, so that behaviors can
    name state classes defined in it.

    Args:
        name: `FILE.py:NAME`; without `:NAME` the only behavior in the file.

    Raises:
        DocumentError: the file cannot be run, or has no such behavior; names the line.
    """
    path, _, requested = name.partition(".py:")
    file = Path(path if path.endswith(".py") else f"{path}.py")
    start = Position(file=str(file), line=1, column=1)
    if not file.is_file():
        raise DocumentError("there is no such file", where=start, hint="check its path")
    found = {key: value for key, value in vars(_module(file, start)).items() if isinstance(value, Behavior)}
    if requested in found:
        return found[requested]
    if requested:
        hint = did_you_mean(requested, found)
        raise DocumentError(f"this file has no behavior named `{requested}`", where=start, hint=hint)
    if len(found) != 1:
        message = f"this file has several behaviors: {', '.join(found)}" if found else "this file has no behavior"
        hint = f"select one: {file.name}:NAME" if found else "assign one to a name at the top level"
        raise DocumentError(message, where=start, hint=hint)
    return next(iter(found.values()))


def _module(file: Path, start: Position) -> ModuleType:
    known = sys.modules.get(file.stem)
    if known is not None:
        if _is_of(known, file):
            return known
        hint = "rename the file"
        raise DocumentError(f"another module named `{file.stem}` is loaded already", where=start, hint=hint)
    # A separate loader keeps the given path in the positions of nodes.
    loader = SourceFileLoader(file.stem, str(file))
    module = ModuleType(file.stem)
    module.__file__ = str(file)
    with _importable(file):
        sys.modules[file.stem] = module
        try:
            loader.exec_module(module)
            prepare_types()
        except DocumentError:
            del sys.modules[file.stem]
            raise
        except FlexcellError as error:
            del sys.modules[file.stem]
            where = error.where if isinstance(error.where, Position) else _raised_at(error, file)
            raise DocumentError(error.message, where=where, hint=error.hint) from error
        except (Exception, SystemExit) as error:
            # The user's file may raise anything; the error reports the line.
            del sys.modules[file.stem]
            raise DocumentError(describe_cause(cause_of(error)), where=_raised_at(error, file)) from error
    return module


@contextmanager
def _importable(file: Path) -> Generator[None]:
    folder = str(file.resolve().parent)
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        with suppress(ValueError):
            sys.path.remove(folder)


def _is_of(module: ModuleType, file: Path) -> bool:
    return module.__file__ is not None and Path(module.__file__).resolve() == file.resolve()


def _raised_at(error: BaseException, file: Path) -> Position:
    """Return the line of the file that led to the error."""
    if isinstance(error, SyntaxError) and error.filename:
        return Position(file=error.filename, line=error.lineno or 1, column=error.offset or 1)
    own = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(file)]
    return Position(file=str(file), line=(own[-1].lineno or 1) if own else 1, column=1)
