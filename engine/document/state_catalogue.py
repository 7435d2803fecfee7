"""The classes that documents may name; a lookup imports nothing.

A catalogue is created once, at the start of a command or server, by `engine.registry.load_states`; its content is
replaced when modules of the project have changed (`engine.library.state_reloading`). Any mapping of names to states can
be used as one when no modules are allowed.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType, ModuleType

from engine.document.project_file import PROJECT_FILE
from engine.errors import ModuleNotAllowed, RegistryError
from engine.state import State
from engine.wording.suggestions import did_you_mean

Catalogue = Mapping[str, type[State]]

NO_CLASSES: Mapping[str, type] = MappingProxyType({})


class StateCatalogue(Mapping[str, type[State]]):
    """The states by name: registered ones, and those of the modules that the project allows.

    Args:
        states: By registered name, and as `module:Class`.
        modules: The loaded modules that the project allows.
        broken: The error of each name, module or entry point that could not be loaded.
        project_file: The file that allows modules; None when there is no project file yet.
        sources: The file of each module of the project that was imported for its states, by module name.
    """

    def __init__(
        self,
        states: Catalogue,
        *,
        modules: Mapping[str, ModuleType] | None = None,
        broken: Mapping[str, RegistryError] | None = None,
        project_file: str | None = None,
        sources: Mapping[str, Path] | None = None,
    ) -> None:
        self._states = dict(sorted(states.items()))
        self._added: Catalogue = {}
        self.modules: Mapping[str, ModuleType] = dict(modules or {})
        self.broken: Mapping[str, RegistryError] = dict(broken or {})
        self.sources: Mapping[str, Path] = dict(sources or {})
        self.outdated: RegistryError | None = None
        """Why the changed modules of the project could not be loaded anew; their classes are those from before."""
        self._project_file = project_file

    def __getitem__(self, name: str) -> type[State]:
        return self._states[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._states)

    def __len__(self) -> int:
        return len(self._states)

    def including(self, classes: Mapping[str, type]) -> StateCatalogue:
        """Return a catalogue with additional states, such as those that a Python file passes to its behavior."""
        states = {name: kind for name, kind in classes.items() if issubclass(kind, State)}
        made = StateCatalogue(
            {**self._states, **states},
            modules=self.modules,
            broken=self.broken,
            project_file=self._project_file,
            sources=self.sources,
        )
        made.outdated = self.outdated
        made._added = {**self._added, **states}
        return made

    def adopt(self, other: StateCatalogue) -> None:
        """Take the content of another catalogue; additional states stay."""
        # Whoever reads meanwhile has the old mapping or the new one, never a part of each.
        self._states = dict(sorted({**other._states, **self._added}.items()))
        self.modules, self.broken, self.sources = other.modules, other.broken, other.sources
        self.outdated = None

    def outdated_class(self, state: type[State]) -> RegistryError | None:
        """Return why a class is older than its file; None if it is not."""
        return self.outdated if state.__module__ in self.sources else None

    def missing(self, name: str) -> RegistryError:
        """Return the error for a missing state, with a hint."""
        module = name.rpartition(":")[0]
        known = self.broken.get(name) or self.broken.get(module)
        if known is not None:
            return known
        if module and module not in self.modules:
            return not_allowed(module, self._project_file)
        missing = "; ".join(map(str, self.broken.values()))
        hint = did_you_mean(name, self._states)
        return RegistryError(f"there is no state `{name}`", hint=f"{hint}; {missing}" if missing else hint)

    def module(self, name: str) -> ModuleType:
        """Return a module that documents may name; raises RegistryError when it is not allowed or failed to load."""
        found = self.modules.get(name)
        if found is None:
            raise self.broken.get(name) or not_allowed(name, self._project_file)
        return found


def module_of(catalogue: Catalogue, name: str) -> ModuleType:
    """Return a module that documents may name.

    Raises:
        ModuleNotAllowed: the project does not allow it.
        RegistryError: it could not be loaded.
    """
    if isinstance(catalogue, StateCatalogue):
        return catalogue.module(name)
    raise not_allowed(name)


def not_allowed(module: str, project_file: str | None = None) -> ModuleNotAllowed:
    """Return the error for a module that a document names and no project file allows."""
    if not module:
        return ModuleNotAllowed("the name has no module", hint="write it as package.module:Class")
    if project_file is None:
        advice = f"write `flexcell: 1` and `states: [{module}]` into {PROJECT_FILE} in your project folder"
    else:
        advice = f"add `{module}` to `states` in {project_file}"
    return ModuleNotAllowed(f"the project does not allow documents to name the module `{module}`", hint=advice)


def loaded_class(name: str) -> type | None:
    """Return the class `module:Class` of a loaded module; imports nothing."""
    module_name, _, class_name = name.partition(":")
    module = sys.modules.get(module_name)
    found = vars(module).get(class_name) if module is not None else None
    return found if isinstance(found, type) else None


def find_state(catalogue: Catalogue, name: str, given: Mapping[str, type] = NO_CLASSES) -> type[State]:
    """Return the state that a document names.

    Args:
        catalogue: The states by name.
        name: The name in the document.
        given: The classes that the behavior uses in Python.

    Raises:
        ModuleNotAllowed: the state is in a module that the project does not allow.
        RegistryError: there is no state of this name, or its package or module failed to load.
    """
    found = given.get(name) or catalogue.get(name)
    if found is None:
        raise _missing(catalogue, name)
    if not issubclass(found, State):
        raise RegistryError("this is not a subclass of engine.state.State", where=name)
    return found


def _missing(catalogue: Catalogue, name: str) -> RegistryError:
    if isinstance(catalogue, StateCatalogue):
        return catalogue.missing(name)
    if ":" in name:
        return not_allowed(name.rpartition(":")[0])
    return RegistryError(f"there is no state `{name}`", hint=did_you_mean(name, catalogue))
