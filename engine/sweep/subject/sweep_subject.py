"""What all runs of a sweep have in common, loaded and checked, with the hash by which versions are told apart."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Self

import msgspec

from engine.authoring.python_file import load_python_behavior
from engine.check import check_behavior, require_no_errors
from engine.document import Behavior, load_behavior
from engine.document.cell import Cell, load_cell
from engine.document.cell_store_spec import SqliteStoreSpec
from engine.document.faults import Faults, load_faults
from engine.document.project_file import ProjectFile, find_project
from engine.document.python_name import is_python_name
from engine.document.simulated_devices import with_simulated_devices
from engine.document.state_catalogue import StateCatalogue
from engine.document.substitutes import Substitutes, load_substitutes
from engine.document.sweep import NO_FILE, Factor, Sweep
from engine.errors import ControlError, DocumentError
from engine.project.run_request import require_simulation
from engine.registry import load_states
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.plan import Plan, new_plan
from engine.sweep.design.distributions import nominal
from engine.sweep.subject.cell_files import model_files
from engine.sweep.subject.cell_variation import varied_cell, written_value
from engine.sweep.subject.source_files import SourceFile, with_imports
from engine.sweep.subject.store_copy import entries_hash
from engine.wording.suggestions import did_you_mean

_PACKAGE = "flexcell"
_HASH = 64
"""The length of a hash."""
_EXTRA = re.compile(r"extra *== *['\"](\w+)['\"]")


@dataclass(frozen=True, kw_only=True)
class SweepSubject:
    """The behavior, cell, faults and substitutes of a sweep; the same in every process that executes it."""

    sweep: Sweep
    catalogue: StateCatalogue
    behavior: Behavior
    cell: Cell | None
    store_file: Path | None
    """The store that each run starts with a copy of; None for the seed entries of the cell."""
    faults: Mapping[str, Faults]
    """By the value of the factor; `""` those of all runs."""
    substitutes: Mapping[str, Substitutes]
    plans: Mapping[str, Plan]
    """By the value of the factor `substitutes`; `""` without the factor."""
    project: ProjectFile | None
    """The project of the behavior."""
    versions: Mapping[str, str]
    """The hashes and versions of all that decides a run beside its configuration, by what they are of."""

    @cached_property
    def hash(self) -> str:
        """The hash of `versions`."""
        return sha256(msgspec.json.encode(dict(self.versions), order="deterministic")).hexdigest()

    @cached_property
    def nominal(self) -> Mapping[str, object]:
        """The value of each factor where nothing is varied, by address.

        It is that of the sweep, else the default of the parameter or the value written in the cell, else 0 for a
        displacement, else the first value or the median of the factor.
        """
        return {address: self._nominal(address, factor) for address, factor in self.sweep.document.factors.items()}

    def _nominal(self, address: str, factor: Factor) -> object:
        kind, _, name = address.partition(".")
        found: object = factor.nominal
        if found is None and kind == "parameters":
            found = self.behavior.parameters[name].default
        elif found is None and kind == "cell" and self.cell is not None:
            found = written_value(self.cell, name)
        elif found is None and kind == "displace":
            found = 0.0
        return found if found is not None else nominal(factor)

    def without_placement_noise(self) -> Self:
        """Return the same subject with each part where the cell has it."""
        document = msgspec.structs.replace(self.sweep.document, placement_noise=False)
        return replace(
            self,
            sweep=replace(self.sweep, document=document),
            versions={**self.versions, "placement_noise": str(document.placement_noise)},
        )

    @classmethod
    def load(cls, sweep: Sweep) -> Self:
        """Load everything that a sweep names, and check it with the nominal value of each factor.

        Raises:
            DocumentError: a document cannot be read or has errors, or a factor names nothing.
            ControlError: a device of the cell is real.
        """
        document = sweep.document
        name = sweep.resolve(document.behavior)
        project = find_project(Path(name))
        catalogue = load_states(Path(name))
        behavior = load_python_behavior(name) if is_python_name(name) else load_behavior(Path(name))
        cell_file = Path(sweep.resolve(document.cell)) if document.cell is not None else behavior.cell_file
        cell = with_simulated_devices(load_cell(cell_file), document.simulate) if cell_file is not None else None
        _require_no_real_devices(cell)
        _require_targets(sweep, behavior, cell)
        require_no_errors(check_behavior(behavior, catalogue, cell=cell))
        faults = {key: load_faults(file) for key, file in _files(sweep, "faults").items()}
        substitutes = {key: load_substitutes(file) for key, file in _files(sweep, "substitutes").items()}
        plans = {key: new_plan(behavior.with_substitutes(each), catalogue) for key, each in substitutes.items()}
        for key in (NO_FILE, ""):
            plans.setdefault(key, new_plan(behavior, catalogue))
        for plan in plans.values():
            require_simulation(plan, cell)
        store_file = _store_file(sweep, cell)
        return cls(
            sweep=sweep,
            catalogue=catalogue,
            behavior=behavior,
            cell=cell,
            store_file=store_file,
            faults=faults,
            substitutes=substitutes,
            plans=plans,
            project=project,
            versions={
                "behavior": behavior.meaning,
                "cell": _hash_of(cell.document) if cell is not None else "",
                "entries": entries_hash(cell, store_file) if cell is not None else "",
                "parameters": _hash_of({**document.parameters, "inputs": document.inputs}),
                "states": _files_hash(state_sources(plans.values(), importable_folders(project, behavior))),
                "placement_noise": str(document.placement_noise),
                "limit": str(document.limit),
                **{f"faults {key}": _hash_of(each.document) for key, each in faults.items()},
                **{f"substitutes {key}": _hash_of(each.document) for key, each in substitutes.items()},
                **(_models(cell) if cell is not None else {}),
                **environment_versions(),
            },
        )


def importable_folders(project: ProjectFile | None, behavior: Behavior) -> Sequence[Path]:
    """Return the folders whose modules the states of a behavior can import."""
    python = [behavior.file.resolve().parent] if behavior.file.suffix == ".py" else []
    return python if project is None else [*python, project.folder]


def environment_versions() -> dict[str, str]:
    """Return the versions of Python and of the packages that a run may use, by name."""
    return {"python": ".".join(map(str, sys.version_info[:3])), **package_versions()}


def package_versions() -> dict[str, str]:
    """Return the version of this package, and of each installed one that a run may use, by name."""
    found = {_PACKAGE: version(_PACKAGE)}
    for requirement in requires(_PACKAGE) or ():
        named = re.match(r"[A-Za-z0-9._-]+", requirement)
        extra = _EXTRA.search(requirement)
        if named is None or (extra is not None and extra[1] != "sim"):
            continue
        try:
            found[named[0].lower()] = version(named[0])
        except PackageNotFoundError:
            continue
    return dict(sorted(found.items()))


def other_versions(found: Mapping[str, str], due: Mapping[str, str]) -> str:
    """Return what differs between two `versions` of a subject, on one line; empty if nothing does."""
    names = sorted(name for name in {*found, *due} if found.get(name) != due.get(name))
    return ", ".join(f"{name}{_version_text(found.get(name), due.get(name))}" for name in names)


def _version_text(found: str | None, due: str | None) -> str:
    """Return both versions; nothing for hashes, which tell a reader nothing."""
    known = [each for each in (found, due) if each]
    return "" if any(len(each) == _HASH for each in known) else f" {found or 'missing'} instead of {due or 'none'}"


def _models(cell: Cell) -> dict[str, str]:
    """Return the hash of the model folders and calibrations of a cell; nothing if all its models are built in."""
    files = list(model_files(cell))
    return {"models": _files_hash(files)} if files else {}


def _files(sweep: Sweep, kind: str) -> dict[str, str]:
    """Return the documents of a kind by their names in the sweep; that of all runs has the name `""`."""
    fixed: str | None = getattr(sweep.document, kind)
    factor = sweep.document.factors.get(kind)
    named = {str(value) for value in factor.values or () if value != NO_FILE} if factor is not None else set[str]()
    files = {name: sweep.resolve(name) for name in sorted(named)}
    return files if fixed is None else {**files, "": sweep.resolve(fixed)}


def _require_no_real_devices(cell: Cell | None) -> None:
    """Refuse to execute a sweep with real devices: it moves them many times, and nobody looks on."""
    real = cell.document.real_devices if cell is not None else {}
    if cell is not None and real:
        raise ControlError(
            f"a sweep drives no real devices, and these of {cell.name} are real: {', '.join(real)}",
            where=cell.file,
            hint="simulate them: `--simulate all`, or `simulate: [all]` in the sweep",
        )


def _store_file(sweep: Sweep, cell: Cell | None) -> Path | None:
    document = sweep.document
    if document.store is not None:
        file = Path(sweep.resolve(document.store))
        if not file.is_file():
            where = sweep.source.position(("store",))
            raise DocumentError(f"there is no store {file}", where=where, hint="an SQLite file of `flexcell`")
        return file
    named = cell.document.store if cell is not None else None
    if named is None:
        return None
    if not isinstance(named, SqliteStoreSpec):
        where = sweep.source.position(("store",))
        raise DocumentError(
            "the store of the cell is on a server, and runs of a sweep change entries side by side",
            where=where,
            hint="`store: FILE` gives each run a copy of an SQLite file",
        )
    return Path(named.path) if Path(named.path).is_file() else None


def _require_targets(sweep: Sweep, behavior: Behavior, cell: Cell | None) -> None:
    """Reject factors and fixed values that name nothing in the behavior or cell."""
    values = {address: nominal(factor) for address, factor in sweep.document.factors.items()}
    for address in values:
        kind, _, name = address.partition(".")
        known = behavior.parameters if kind == "parameters" else behavior.document.userdata
        if kind == "parameters" and name not in known:
            hint = did_you_mean(name, known)
            raise DocumentError(f"the behavior has no parameter `{name}`", where=sweep.position(address), hint=hint)
        if kind in ("cell", "displace") and cell is None:
            raise DocumentError(
                f"`{address}` needs a cell", where=sweep.position(address), hint="`cell: FILE`, here or in the behavior"
            )
    if cell is not None:
        for address, value in values.items():
            try:
                varied_cell(cell, {address: value})
            except DocumentError as error:
                raise DocumentError(error.message, where=sweep.position(address), hint=error.hint) from error


def state_sources(plans: Iterable[Plan], projects: Iterable[Path]) -> set[Path]:
    """Return the files in which the states of some plans are defined, with what they import of their projects."""
    states = {node.work.state for plan in plans for node in plan.nodes.values() if isinstance(node.work, Leaf)}
    files = ((state.__module__, inspect.getsourcefile(state)) for state in states)
    start = [SourceFile(module, Path(file).resolve()) for module, file in files if file is not None]
    return with_imports(start, projects)


def _files_hash(files: Iterable[Path]) -> str:
    # Their folders differ between machines, their order must not.
    return _hash_of(sorted(_file_hash(file) for file in files))


def _hash_of(content: object) -> str:
    return sha256(msgspec.json.encode(content, order="deterministic")).hexdigest()


def _file_hash(file: Path | None) -> str:
    return sha256(file.read_bytes()).hexdigest() if file is not None and file.is_file() else ""
