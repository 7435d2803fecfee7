"""Finds states, worlds, drivers and servers by name, through the entry points of installed packages.

Groups: `flexcell.states` (a mapping of state name → class), `flexcell.worlds` and
`flexcell.drivers` (a factory per `kind`), `flexcell.servers`, `flexcell.models` (see
`engine.cell.robot_models`), which also offer the kinds of tools with their states. A user's own
states are in modules that the project file allows, and are named `module:Class`. Only `load_states`
imports such modules: at the start of a command or server, never because a document names them.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterable, Mapping
from functools import cache, partial
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol, cast

from engine.document.project_file import ProjectFile, find_project
from engine.document.state_catalogue import StateCatalogue
from engine.errors import RegistryError
from engine.host.isolated_loading import LoadFailure, load_isolated
from engine.state import State
from engine.type_preparation import prepare_types
from engine.wording.suggestions import did_you_mean

STATES = "flexcell.states"
WORLDS = "flexcell.worlds"
DRIVERS = "flexcell.drivers"
SERVERS = "flexcell.servers"
MODELS = "flexcell.models"
_PACKAGES = frozenset(("engine", "states", "robots", "editor_web", "behaviors"))
"""The packages of flexcell, which are in the project folder where one works on flexcell itself."""


class _BringsStates(Protocol):
    """A kind of tool (`engine.cell.tool_kind`), as far as its states are concerned."""

    @property
    def states(self) -> tuple[type[State], ...]: ...


class _BringsTools(Protocol):
    """The installed models (`engine.cell.robot_models`), as far as their kinds of tools are concerned."""

    def tool_kinds(self) -> Mapping[str, _BringsStates]: ...


def load_states(start: Path | None = None) -> StateCatalogue:
    """Load the states of installed packages, and those of the modules that a project allows.

    A package or module that fails to load is skipped; the catalogue reports its error when it is needed.

    Args:
        start: A file or folder; the nearest project file in its folder or above is used. None for no project.

    Raises:
        DocumentError: the project file is not valid.
    """
    project = find_project(start) if start is not None else None
    loading = _Loading()
    for point in entry_points(group=STATES):
        loading.add_entry_point(point)
    if "standard" in registered_names(MODELS):
        loading.add_tool_kinds()
    if project is not None:
        loading.add_project(project)
    prepare_types()
    file = str(project.file) if project is not None else None
    return StateCatalogue(
        loading.states, modules=loading.modules, broken=loading.broken, project_file=file, sources=loading.sources
    )


def state_by_path(name: str) -> type[State]:
    """Import and return the state class named `package.module:Class` on the command line.

    Raises:
        RegistryError: the module or class does not exist or is not a state.
    """
    module_name, _, class_name = name.partition(":")
    module = load_isolated(module_name, partial(importlib.import_module, module_name))
    if isinstance(module, LoadFailure):
        raise RegistryError(str(module), where=name, hint="write it as package.module:Class")
    found: object = vars(module).get(class_name)
    if not (isinstance(found, type) and issubclass(found, State)):
        hint = did_you_mean(class_name, _states_of(module))
        raise RegistryError("this is not a subclass of engine.state.State", where=name, hint=hint)
    return found


def registered_names(group: str) -> tuple[str, ...]:
    """Return the names that installed packages register in a group, sorted; nothing is loaded."""
    return tuple(sorted(point.name for point in entry_points(group=group)))


def load_factory(group: str, kind: str) -> Any:
    """Return what is registered as `kind` in `group`.

    Raises:
        RegistryError: nothing is; suggests similar names, or the extra that provides it.
    """
    points = {point.name: point for point in entry_points(group=group)}
    if kind not in points:
        raise RegistryError(
            f"no {group.removeprefix('flexcell.')[:-1]} is named {kind!r}", hint=did_you_mean(kind, points)
        )
    found = load_isolated(kind, points[kind].load)
    if isinstance(found, LoadFailure):
        raise _broken_point(points[kind], found)
    return found


def installed_state(name: str) -> type[State]:
    """Return a state of an installed package or of a kind of tool, by its name.

    Raises:
        RegistryError: there is none; suggests similar names.
    """
    models = _models()
    kinds = models.tool_kinds().values() if models is not None else ()
    found = {state.state_name: state for kind in kinds for state in kind.states}
    for offered in _installed_states():
        found.update(offered)
    if name not in found:
        raise RegistryError(f"no installed state is named {name!r}", hint=did_you_mean(name, found))
    return found[name]


# Cached: reading the lists of installed packages takes 20 ms.
@cache
def _models() -> _BringsTools | None:
    try:
        return load_factory(MODELS, "standard")
    except RegistryError:
        return None


@cache
def _installed_states() -> tuple[dict[str, type[State]], ...]:
    loaded = (load_isolated(point.name, partial(_offered, point)) for point in entry_points(group=STATES))
    return tuple(offered for offered in loaded if not isinstance(offered, LoadFailure))


class _Loading:
    """The states loaded so far, and the errors of those that could not be loaded."""

    def __init__(self) -> None:
        self.states: dict[str, type[State]] = {}
        self.modules: dict[str, ModuleType] = {}
        self.broken: dict[str, RegistryError] = {}
        self.sources: dict[str, Path] = {}

    def add_entry_point(self, point: EntryPoint) -> None:
        offered = load_isolated(point.name, partial(_offered, point))
        if isinstance(offered, LoadFailure):
            self.broken[point.name] = _broken_point(point, offered)
            return
        for name, state in offered.items():
            self._add(name, state, point.value)

    def add_tool_kinds(self) -> None:
        try:
            models: _BringsTools = load_factory(MODELS, "standard")
        except RegistryError as error:
            self.broken["models"] = error
            return
        for kind in models.tool_kinds().values():
            for state in kind.states:
                self._add(state.state_name, state, state.__module__)

    def add_project(self, project: ProjectFile) -> None:
        folder = str(project.folder)
        if folder not in sys.path:
            # At the end: a module of the project must not shadow a library that is imported later.
            sys.path.append(folder)
        importlib.invalidate_caches()
        before = set(sys.modules)
        for index, name in enumerate(project.document.states):
            loaded = load_isolated(name, partial(_own_module, name, project.folder))
            if isinstance(loaded, LoadFailure):
                where = project.position(index)
                self.broken[name] = RegistryError(
                    str(loaded), where=where, hint="fix the module; a server loads it again when it changes"
                )
                continue
            self.modules[name], states = loaded
            for class_name, state in states.items():
                self.states[f"{name}:{class_name}"] = state
                if state.state_name and state.__module__ == name:
                    self._add(state.state_name, state, name)
        self.sources = own_sources(project.folder, {*project.document.states, *(set(sys.modules) - before)})
        # A module that has failed is loaded when it is corrected.
        failed = ((name, _own_files(project.folder, name)) for name in project.document.states if name in self.broken)
        self.sources |= {name: files[0] for name, files in failed if files}

    def _add(self, name: str, state: type[State], origin: str) -> None:
        known = self.states.get(name)
        if name in self.broken or (known is not None and known is not state):
            self.states.pop(name, None)
            hint = "rename one of them, or uninstall one package"
            self.broken[name] = RegistryError(f"two packages provide the state {name}", where=origin, hint=hint)
        else:
            self.states[name] = state


def _offered(point: EntryPoint) -> dict[str, type[State]]:
    """Return the states of an entry point after checking their types: it may return anything."""
    offered: dict[str, type[State]] = {}
    for name, state in cast("Mapping[str, object]", point.load()).items():
        if not (isinstance(state, type) and issubclass(state, State)):
            raise TypeError(f"{name} is not a subclass of engine.state.State")
        offered[name] = state
    return offered


def _own_module(name: str, folder: Path) -> tuple[ModuleType, dict[str, type[State]]]:
    """Import a module with its states; another module of the same name must not shadow that of the project folder."""
    module = importlib.import_module(name)
    own = _own_files(folder, name)
    if own and module.__file__ is not None and Path(module.__file__).resolve() not in own:
        raise ImportError(f"another module of this name is loaded from {module.__file__}; rename {own[0]}")
    return module, _states_of(module)


def own_sources(folder: Path, names: Iterable[str]) -> dict[str, Path]:
    """Return the file of each loaded module that is in a project folder under its own name; none of flexcell itself."""
    found: dict[str, Path] = {}
    for name in names:
        file = getattr(sys.modules.get(name), "__file__", None)
        if isinstance(file, str) and Path(file).resolve() in _own_files(folder, name):
            found[name] = Path(file).resolve()
    return found


def _own_files(folder: Path, name: str) -> list[Path]:
    """Return the files of a project folder that are a module of this name; empty for the packages of flexcell."""
    if name.partition(".")[0] in _PACKAGES:
        return []
    path = folder.joinpath(*name.split("."))
    return [file.resolve() for file in (path.with_suffix(".py"), path / "__init__.py") if file.is_file()]


def _states_of(module: ModuleType) -> dict[str, type[State]]:
    found = ((name, value) for name, value in vars(module).items() if isinstance(value, type))
    return {name: value for name, value in found if issubclass(value, State) and value is not State}


def _broken_point(point: EntryPoint, failure: LoadFailure) -> RegistryError:
    if failure.raised.startswith(("ImportError", "ModuleNotFoundError")):
        return RegistryError(
            f"{point.name} needs a package that is not installed: {failure.raised.partition(': ')[2]}",
            where=point.value,
            hint="pip install 'flexcell[all]'",
        )
    package = point.dist.name if point.dist is not None else "its package"
    return RegistryError(str(failure), where=point.value, hint=f"fix or uninstall {package}")
