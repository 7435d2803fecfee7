"""Prepares every msgspec type before a second thread can use it.

msgspec builds its type information of a `Struct` at the first decoding or conversion. It publishes
that record before its fields are filled in, so a second thread that uses the type meanwhile reads
null pointers and the process ends with SIGSEGV (msgspec 0.22.0, decision 0023).

`prepare_on_import` makes every module of a package prepare its types as the last step of its import,
under one lock: until then no other thread can access them. Types created in other ways (a class in a
notebook, a module of a user) are prepared by `prepare_type` or `prepare_types`.
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

    # Imported with the first module that defines a type: `flexcell stop` does not need it.
    from msgspec import Struct, StructMeta
else:
    # Importing the classes themselves would be a third of the imports of that command.
    Loader = MetaPathFinder = object

_lock = RLock()
_waiting: list[StructMeta] = []
"""Types that refer to types that do not exist yet, as in modules that import each other."""


def prepare_type(kind: type[Struct]) -> None:
    """Prepare one type and all types of its fields."""
    with _lock:
        _prepare([kind])


def prepare_types() -> None:
    """Prepare all types of this process; cheap for types that are already prepared."""
    from msgspec import Struct

    with _lock:
        _prepare(list(_subclasses(Struct)))


def prepare_on_import(*packages: str) -> None:
    """Make the modules of these packages, by top-level name, prepare their types on import."""
    _importer.packages |= set(packages)
    if _importer not in sys.meta_path:
        sys.meta_path.insert(0, _importer)


def _prepare(kinds: list[StructMeta]) -> None:
    from msgspec.json import Decoder

    pending = [*_waiting, *kinds]
    _waiting.clear()
    for kind in pending:
        try:
            Decoder(kind)
        except (NameError, AttributeError):
            # An annotation refers to a later definition in this module, or in one that imports it.
            _waiting.append(kind)
        except TypeError:
            # msgspec cannot decode such a type; its use raises this error, without an incomplete record.
            continue


def _subclasses(kind: StructMeta) -> Iterator[StructMeta]:
    for each in type.__subclasses__(kind):
        yield each
        yield from _subclasses(each)


def _types_of(module: ModuleType) -> Iterator[StructMeta]:
    """Yield the types of a module and its classes; imported types cost almost nothing."""
    from msgspec import StructMeta

    pending: list[Mapping[str, object]] = [vars(module)]
    seen: set[type] = set()
    for names in pending:
        for value in tuple(names.values()):
            if isinstance(value, StructMeta):
                yield value
            if isinstance(value, type) and value.__module__ == module.__name__ and value not in seen:
                seen.add(value)
                pending.append(vars(value))


class _PreparingLoader(Loader):
    """Loads a module with its own loader and then prepares its types."""

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
    """Finds the modules of the prepared packages with the other importers."""

    def __init__(self) -> None:
        self.packages: set[str] = set()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname.partition(".")[0] not in self.packages:
            return None
        for importer in sys.meta_path:
            if importer is self or isinstance(importer, _Importer):
                continue
            spec = importer.find_spec(fullname, path, target)
            if spec is not None:
                if spec.loader is not None:
                    spec.loader = _PreparingLoader(spec.loader)
                return spec
        return None


_importer = _Importer()
