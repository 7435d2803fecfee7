"""Loads changed modules of the project's own states anew, into fresh module objects, while a server runs.

Modules are those that were imported for the states that the project file allows, as far as they are files of the
project. Classes from before stay what they are: who has one keeps it.
"""

from __future__ import annotations

import importlib.util
import sys
import threading
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import ModuleType

from engine.document.project_file import find_project
from engine.document.state_catalogue import Catalogue, StateCatalogue
from engine.errors import FlexcellError, RegistryError
from engine.registry import load_states, own_sources

Stamps = Mapping[Path, tuple[int, int]]
"""Modification time (ns) and size of each file."""


class StateReloading:
    """Watches the modules of one catalogue; thread-safe.

    Args:
        project: A folder of the project.
        catalogue: The states, whose content is replaced; one without modules of the project is never due.
    """

    def __init__(self, project: Path, catalogue: Catalogue) -> None:
        self._project = project
        self._catalogue = catalogue if isinstance(catalogue, StateCatalogue) else None
        self._lock = threading.Lock()
        self._stamps = _stamps(self._files())

    @property
    def modules(self) -> frozenset[str]:
        """The names of the watched modules."""
        return frozenset(self._catalogue.sources) if self._catalogue is not None else frozenset()

    def is_due(self) -> bool:
        """Return whether a watched file differs from what was loaded last; cheap enough to poll each second."""
        return _stamps(self._files()) != self._stamps

    def load(self) -> bool:
        """Load all watched modules anew, or none; return whether the catalogue has changed.

        After an import that fails the classes stay, and the catalogue says why they are outdated.
        """
        catalogue = self._catalogue
        if catalogue is None:
            return False
        with self._lock:
            # Before the files are read: what changes meanwhile is due again.
            stamps = _stamps(self._files())
            if stamps == self._stamps:
                return False
            before = catalogue.outdated
            made = self._loaded(catalogue)
            if isinstance(made, StateCatalogue):
                catalogue.adopt(made)
            else:
                catalogue.outdated = made
            # Other files are watched now: those that were imported, or those around a failed import.
            now = _stamps(self._files())
            self._stamps = {file: stamps.get(file, stamp) for file, stamp in now.items()}
            return isinstance(made, StateCatalogue) or str(before) != str(made)

    def _loaded(self, catalogue: StateCatalogue) -> StateCatalogue | RegistryError:
        watched = dict(catalogue.sources)
        kept = {name: sys.modules.pop(name) for name in watched if name in sys.modules}
        _forget_bytecode(watched.values())
        names = set(sys.modules)
        try:
            made = load_states(self._project)
        except FlexcellError as error:
            _put_back(kept, ())
            return RegistryError(error.message, where=error.where, hint=error.hint)
        failures = [made.broken[name] for name in catalogue.modules if name in made.broken]
        if not failures:
            return made
        project = find_project(self._project)
        fresh = own_sources(project.folder, set(sys.modules) - names) if project is not None else {}
        _put_back(kept, fresh)
        return RegistryError(
            failures[0].message,
            where=failures[0].where,
            hint="correct the module; until then the class from before is used",
        )

    def _files(self) -> Iterable[Path]:
        catalogue = self._catalogue
        if catalogue is None:
            return ()
        files = set(catalogue.sources.values())
        if catalogue.outdated is not None:
            # What failed may be a module that is imported for the first time.
            files |= {beside for folder in {file.parent for file in files} for beside in folder.glob("*.py")}
        return files


def _put_back(kept: Mapping[str, ModuleType], fresh: Iterable[str]) -> None:
    """Let the modules from before be those that imports find, also as attributes of their packages."""
    for name in fresh:
        sys.modules.pop(name, None)
    sys.modules.update(kept)
    for name, module in kept.items():
        package, _, own = name.rpartition(".")
        if package in sys.modules:
            setattr(sys.modules[package], own, module)


def _forget_bytecode(files: Iterable[Path]) -> None:
    """Delete the compiled files: a change within the same second, of the same length, would be missed."""
    for file in files:
        try:
            Path(importlib.util.cache_from_source(str(file))).unlink(missing_ok=True)
        except (OSError, NotImplementedError):
            continue  # a read-only folder; the time of the source then decides


def _stamps(files: Iterable[Path]) -> Stamps:
    found: dict[Path, tuple[int, int]] = {}
    for file in files:
        try:
            status = file.stat()
        except OSError:
            found[file] = (0, 0)  # deleted
            continue
        found[file] = (status.st_mtime_ns, status.st_size)
    return found
