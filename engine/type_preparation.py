"""Makes every msgspec type ready before a second thread can see it.

msgspec builds what it knows of a `Struct` when the type is first decoded or converted to. It publishes
that record before its fields are filled in, so a second thread that uses the type meanwhile reads
null pointers and the process ends with SIGSEGV (msgspec 0.22.0, decision 0023).

`prepare_on_import` has every module of a package make its types ready as the last step of its import,
under one lock: until then no other thread can reach them. Types made in another way (a class in a
notebook, a module of a user) are made ready by `prepare_type` or `prepare_types`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from importlib.machinery import ModuleSpec
from threading import RLock
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.abc import Loader, MetaPathFinder

    # Loaded with the first module that defines a type: the command that stops a cell does without.
    from msgspec import Struct, StructMeta
else:
    # The classes themselves would be a third of what that command imports.
    Loader = MetaPathFinder = object

_lock = RLock()
_waiting: list[StructMeta] = []
"""Types that name others which do not exist yet, as in modules that import one another."""


def prepare_type(kind: type[Struct]) -> None:
    """Make one type, and all types of its fields, ready."""
    with _lock:
        _prepare([kind])


def prepare_types() -> None:
    """Make all types of this process ready, whoever defined them; cheap for those that are."""
    from msgspec import Struct

    with _lock:
        _prepare(list(_subclasses(Struct)))


def prepare_on_import(*packages: str) -> None:
    """Have the modules of these packages, by their top-level names, make their types ready on import."""
    _importer.packages |= set(packages)
    if _importer not in sys.meta_path:
        sys.meta_path.insert(0, _importer)


def _prepare(kinds: list[StructMeta]) -> None:
    from msgspec.json import Decoder

    due = [*_waiting, *kinds]
    _waiting.clear()
    for kind in due:
        try:
            Decoder(kind)
        except (NameError, AttributeError):
            # An annotation names what comes later in a module, or in one that imports this one.
            _waiting.append(kind)
        except TypeError:
            # msgspec cannot decode such a type; whoever tries gets this error, and no half-made record.
            continue


def _subclasses(kind: StructMeta) -> Iterator[StructMeta]:
    for each in type.__subclasses__(kind):
        yield each
        yield from _subclasses(each)


def _types_of(module: ModuleType) -> Iterator[StructMeta]:
    """Go through the types that a module holds, in its classes too; those it imported cost next to nothing."""
    from msgspec import StructMeta

    due: list[Mapping[str, object]] = [vars(module)]
    seen: set[type] = set()
    for names in due:
        for value in tuple(names.values()):
            if isinstance(value, StructMeta):
                yield value
            if isinstance(value, type) and value.__module__ == module.__name__ and value not in seen:
                seen.add(value)
                due.append(vars(value))


class _PreparingLoader(Loader):
    """Loads a module as its own loader does, and then makes its types ready."""

    def __init__(self, own: Loader) -> None:
        self._own = own

    def __getattr__(self, name: str) -> object:
        return getattr(self._own, name)

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self._own.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        self._own.exec_module(module)
        if "msgspec" in sys.modules:
            with _lock:
                _prepare(list(_types_of(module)))


class _Importer(MetaPathFinder):
    """Finds the modules of some packages where the other finders do."""

    def __init__(self) -> None:
        self.packages: set[str] = set()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname.partition(".")[0] not in self.packages:
            return None
        for finder in sys.meta_path:
            if finder is self or isinstance(finder, _Importer):
                continue
            spec = finder.find_spec(fullname, path, target)
            if spec is not None:
                if spec.loader is not None:
                    spec.loader = _PreparingLoader(spec.loader)
                return spec
        return None


_importer = _Importer()
