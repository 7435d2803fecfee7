"""Sweep documents: one behavior executed many times with varied factors, and what is required of its runs.

    flexcell: 1
    behavior: two_arm_transfer.yaml
    factors:
      parameters.speed: {uniform: [0.3, 1.0]}
      displace.hca_north.x_m: {normal: {deviation: 0.004}}
      cell.parts.hca_north.mass_kg: {log_uniform: [0.05, 0.5]}
      faults: {values: [none, slip.yaml]}
    design: random
    runs: 500
    require: success >= 0.98

The name of a factor is its address: `seed`, `parameters.NAME`, `inputs.KEY`, `displace.PART.x_m` (`y_m`, `z_m`,
`yaw_rad`), `cell.` with the path of a value in the cell document, `faults`, or `substitutes`.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from engine.document.duration import Duration
from engine.document.requirement import Requirement, RequirementText
from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import DataPath, DocumentSource, load_source, parse_source
from engine.errors import DocumentError

Design = Literal["random", "grid", "latin_hypercube", "sobol"]
DISTRIBUTIONS = ("values", "uniform", "log_uniform", "normal")
"""The keys of a factor of which it has exactly one."""
NO_FILE = "none"
"""The value of the factors `faults` and `substitutes` with which there is none."""

_ADDRESS = (
    r"^(seed|parameters\.[A-Za-z_]\w*|inputs\.\w+|displace\.[a-z][a-z0-9_]*\.(x_m|y_m|z_m|yaw_rad)"
    r"|cell(\.[A-Za-z0-9_]+)+|faults|substitutes)$"
)
_ADDRESSES = (
    "`seed`, `parameters.NAME`, `inputs.KEY`, `displace.PART.x_m` (or `y_m`, `z_m`, `yaw_rad`), `cell.PATH.TO.VALUE`, "
    "`faults` or `substitutes`"
)
Address = Annotated[str, Meta(pattern=_ADDRESS, description=_ADDRESSES)]
Percentage = Annotated[float, Meta(gt=0.0, lt=1.0)]


class Normal(StrictModel, frozen=True, kw_only=True):
    """A normal distribution."""

    mean: float = 0.0
    deviation: Annotated[float, Meta(gt=0.0, description="Standard deviation, above 0")]


class Factor(StrictModel, frozen=True, kw_only=True):
    """What a factor is varied over: a list of values, each equally likely, or a distribution of numbers.

    `nominal` is its value where nothing is varied: by default that of the parameter or of the cell. `levels` is the
    number of values that a grid takes of a distribution: the middles of so many equally likely parts.
    """

    values: Annotated[tuple[object, ...], Meta(min_length=1, description="Values, each equally likely")] | None = None
    uniform: tuple[float, float] | None = None
    log_uniform: tuple[float, float] | None = None
    normal: Normal | None = None
    integer: bool = False
    nominal: float | int | str | bool | None = None
    levels: Annotated[int, Meta(ge=1, le=1000, description="Values of a distribution in a grid")] = 5

    @property
    def written(self) -> tuple[str, ...]:
        """The distributions that are given; a valid factor has one."""
        return tuple(name for name in DISTRIBUTIONS if getattr(self, name) is not None)


class PointsFile(StrictModel, frozen=True, kw_only=True):
    """A design read from a file: the header row has addresses, whether they are `factors` or not; a row is a run."""

    csv: Annotated[str, Meta(min_length=1, description="CSV file, relative to this document")]


class SearchSpec(StrictModel, frozen=True, kw_only=True):
    """A search for failures instead of a design: what has ended decides which configurations are executed next.

    The first `batch` configurations are those of a random design; each later batch is drawn nearer to the runs that
    failed, or came nearest to it. `towards` names the number that tells how near a run that succeeded is; with
    `failure` none does. A run that fails is always nearer. The same seed finds the same
    configurations, with any number of workers.

    Of the method `cross_entropy`, `elite` is the share of a batch that the
    next one is drawn around, and `random_share` the share of each batch that is drawn at random all the same: it finds
    what the number does not point at, and bounds the weight of a run in the estimate of the failure probability.
    """

    towards: Annotated[
        str, Meta(pattern=r"^(failure|(least|most) +\S+)$", description="`failure`, `least NAME` or `most NAME`")
    ] = "failure"
    method: Literal["cross_entropy", "optuna"] = "cross_entropy"
    runs: Annotated[int, Meta(ge=1, le=1_000_000, description="Runs, at least 1")] = 200
    batch: Annotated[int, Meta(ge=4, le=100_000, description="Runs between which nothing is learned")] = 20
    stop_after: Annotated[int, Meta(ge=1, description="Failures after which the search ends")] | None = None
    elite: Annotated[float, Meta(gt=0.0, le=0.5)] = 0.2
    random_share: Annotated[float, Meta(ge=0.01, le=1.0)] = 0.2


class SweepDocument(StrictModel, frozen=True, kw_only=True):
    """A sweep as written.

    `interval` of the success rate: `anytime` may be looked at after every run, and a sweep ends as soon as it decides
    what is required; `exact` is narrower, for the number of `runs` that is fixed before. Both are for runs that are
    drawn at random. In another design what is required is compared with the share of its runs.

    `require` is a success rate, `success >= 0.98`, the share of runs in which a number keeps a limit,
    `share(cell.contact_force_max_n <= 30) >= 0.95`, or a list of these. A number is a measure, userdata at the end, or
    `duration_s`; a run without it does not keep the limit.

    Each run has a seed of its own, derived from `seed` and its number; with `placement_noise` it also places the parts
    that have `jitter` in the cell. The budget is the number of `runs`, the wall `time` of the sweep, or the `width` of
    the interval of the success rate; whatever comes first ends it. `timeout` is the wall time of one run, `limit` its
    time on the clock of the run. With `search` the configurations are searched for, `search.runs` of them; what is
    required is then not decided.
    """

    flexcell: Literal[1]
    description: str = ""
    behavior: Annotated[str, Meta(min_length=1, description="Behavior, relative to this document")]
    cell: Annotated[str, Meta(min_length=1, description="Cell, relative to this document")] | None = None
    simulate: Annotated[
        tuple[str, ...], Meta(description="Devices that the world simulates instead of their drivers: names, or `all`")
    ] = ()
    store: Annotated[str, Meta(min_length=1, description="Store file that each run starts with")] | None = None
    parameters: dict[str, object] = {}
    inputs: dict[str, object] = {}
    faults: Annotated[str, Meta(min_length=1, description="Fault document of all runs")] | None = None
    substitutes: Annotated[str, Meta(min_length=1, description="Substitutes document of all runs")] | None = None
    factors: dict[Address, Factor] = {}
    design: Design | PointsFile = "random"
    search: SearchSpec | None = None
    seed: Annotated[int, Meta(ge=0, le=2**53)] = 0
    placement_noise: bool = True
    runs: Annotated[int, Meta(ge=1, le=10_000_000, description="Runs, at least 1")] = 100
    time: Duration | None = None
    width: Percentage | None = None
    interval: Literal["anytime", "exact"] = "anytime"
    confidence: Annotated[float, Meta(ge=0.5, lt=1.0, description="Confidence of intervals, for example 0.95")] = 0.95
    require: (
        RequirementText
        | Annotated[tuple[RequirementText, ...], Meta(min_length=1, description="One or more requirements")]
        | None
    ) = None
    timeout: Duration = 300.0
    limit: Duration = 3600.0

    @property
    def requirements(self) -> tuple[Requirement, ...]:
        """What is required, each once."""
        written = (self.require,) if isinstance(self.require, str) else self.require or ()
        return tuple(dict.fromkeys(map(Requirement.parse, written)))

    @property
    def required_rate(self) -> float | None:
        """The success rate that is required; None where none is."""
        return max((each.rate for each in self.requirements if each.limit is None), default=None)


@dataclass(frozen=True, kw_only=True)
class Sweep(DocumentFile[SweepDocument]):
    """A sweep document with its file."""

    @property
    def text(self) -> bytes:
        """The document, without its comments."""
        return msgspec.json.encode(self.document)

    def resolve(self, path: str) -> str:
        """Return a path of the document, resolved against its folder; `FILE.py:NAME` keeps its name."""
        name, python, function = path.partition(".py:")
        return f"{(self.file.parent / name).resolve()}{python}{function}"

    def position(self, address: str) -> object:
        """Return the position of a factor in the document."""
        return self.source.position(("factors", address), of_key=True)


def load_sweep(path: Path | str) -> Sweep:
    """Read a sweep document.

    Raises:
        DocumentError: the file cannot be read or is not a valid sweep; `where` is the position.
    """
    return sweep_of_source(load_source(Path(path)), file=Path(path))


def parse_sweep(text: bytes | str, *, file: Path | str) -> Sweep:
    """Return the sweep that a text describes; `file` is the name shown in positions, and its paths are relative to it.

    Raises:
        DocumentError: as `load_sweep`.
    """
    return sweep_of_source(parse_source(text, file=str(file)), file=Path(file))


def require_address(text: str, *, where: object) -> None:
    """Raise DocumentError at `where` unless a text is the address of a factor."""
    if not re.fullmatch(_ADDRESS, text):
        raise DocumentError(f"`{text}` is not the address of a factor", where=where, hint=_ADDRESSES)


def sweep_of_source(source: DocumentSource, *, file: Path) -> Sweep:
    """Return the sweep that parsed data describe; `file` is what its paths are relative to.

    Raises:
        DocumentError: as `load_sweep`.
    """
    document = decode_document(source, SweepDocument)
    if document.width is not None and (document.design != "random" or document.interval != "anytime"):
        raise DocumentError(
            "only a random design has an interval that may end the sweep",
            where=source.position(("width",), of_key=True),
            hint="`design: random` and `interval: anytime`, or remove `width`",
        )
    _require_requirements(document, source)
    _require_searchable(document, source)
    for address, factor in document.factors.items():
        path: DataPath = ("factors", address)
        _require_one_distribution(source, path, factor)
        _require_order(source, path, factor)
        _require_target(document, source, path, address, factor)
    return Sweep(document=document, file=file, source=source)


def _require_requirements(document: SweepDocument, source: DocumentSource) -> None:
    if isinstance(document.require, str):
        Requirement.parse(document.require, where=source.position(("require",)))
    else:
        for index, text in enumerate(document.require or ()):
            Requirement.parse(text, where=source.position(("require", index)))


def _require_searchable(document: SweepDocument, source: DocumentSource) -> None:
    if document.search is None:
        return
    where = source.position(("search",), of_key=True)
    if document.design != "random":
        raise DocumentError(
            "a search starts with configurations of a random design",
            where=where,
            hint="`design: random`, or remove `search`",
        )
    if not set(document.factors) - {"seed"}:
        raise DocumentError("a search has nothing to vary", where=where, hint="`factors: {...}`; seeds have no order")


def _require_one_distribution(source: DocumentSource, path: DataPath, factor: Factor) -> None:
    written = factor.written
    if len(written) != 1:
        found = " and ".join(f"`{name}`" for name in written) or "no distribution"
        raise DocumentError(
            f"the factor `{path[-1]}` has {found}",
            where=source.position(path, of_key=True),
            hint="give one of `values`, `uniform`, `log_uniform`, `normal`",
        )
    if factor.integer and factor.values is not None:
        raise DocumentError(
            "`integer` has no effect on `values`", where=source.position((*path, "integer")), hint="remove it"
        )


def _require_order(source: DocumentSource, path: DataPath, factor: Factor) -> None:
    for name in ("uniform", "log_uniform"):
        limits: tuple[float, float] | None = getattr(factor, name)
        if limits is None:
            continue
        where = source.position((*path, name))
        if not limits[0] < limits[1] or not all(math.isfinite(limit) for limit in limits):
            raise DocumentError(f"`{name}` goes from {limits[0]:g} to {limits[1]:g}", where=where, hint="[least, most]")
        if name == "log_uniform" and limits[0] <= 0.0:
            raise DocumentError("`log_uniform` starts above 0", where=where, hint="use `uniform`")


def _require_target(
    document: SweepDocument, source: DocumentSource, path: DataPath, address: str, factor: Factor
) -> None:
    """Reject factors whose values are no names of documents, or whose value is fixed as well."""
    kind, _, name = address.partition(".")
    if kind == "seed":
        if factor.values is None or not all(type(value) is int and value >= 0 for value in factor.values):
            where = source.position(path)
            raise DocumentError("`seed` is varied over integers from 0", where=where, hint="values: [1, 2, 3]")
        fixed = False
    elif kind in ("faults", "substitutes"):
        if factor.values is None or not all(isinstance(value, str) for value in factor.values):
            raise DocumentError(
                f"`{kind}` is varied over names of documents",
                where=source.position(path),
                hint=f"values: [{NO_FILE}, my_{kind}.yaml]",
            )
        fixed = getattr(document, kind) is not None
    else:
        fixed = kind in ("parameters", "inputs") and name in getattr(document, kind)
    if fixed:
        raise DocumentError(
            f"`{address}` is a factor and has a fixed value too",
            where=source.position(path, of_key=True),
            hint="remove one of them",
        )
