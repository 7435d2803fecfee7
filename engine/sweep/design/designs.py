"""Designs: which configurations a sweep executes, in which order."""

from __future__ import annotations

import csv
import itertools
import math
import random
from collections.abc import Iterator, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Literal

import msgspec

from engine.document.sweep import Factor, PointsFile, Sweep, require_address
from engine.errors import DocumentError
from engine.sweep.design.configuration import Configuration
from engine.sweep.design.distributions import levels, value_at


def configurations(sweep: Sweep) -> Sequence[Configuration]:
    """Return the configurations of a sweep, at most as many as it has runs.

    A random or Sobol design of more runs starts with those of fewer, so that a sweep can be made longer. A grid takes
    each combination once, and again with other seeds where it has more runs than combinations.

    Raises:
        DocumentError: the file of a design cannot be used.
    """
    document = sweep.document
    factors = document.factors
    if isinstance(document.design, PointsFile):
        rows = list(_read_points(sweep, document.design.csv))
        # A file is the whole design: its rows are run once, unless `runs` asks for fewer.
        return [configuration_of(document.seed, number, row) for number, row in enumerate(rows[: document.runs])]
    match document.design:
        case "random":
            points = [random_shares(document.seed, number, len(factors)) for number in range(document.runs)]
        case "grid":
            return [configuration_of(document.seed, number, row) for number, row in _grid(factors, document.runs)]
        case "latin_hypercube" | "sobol":
            points = _even_points(document.design, max(len(factors), 1), document.runs, document.seed)
    return [
        configuration_of(
            document.seed,
            number,
            {name: value_at(factor, share) for (name, factor), share in zip(factors.items(), point, strict=False)},
        )
        for number, point in enumerate(points)
    ]


def run_seed(sweep_seed: int, number: int) -> int:
    """Return the seed of a run, below 2**53 so that every reader of JSON keeps it."""
    return int.from_bytes(sha256(f"{sweep_seed}/{number}".encode()).digest()[:8]) >> 11


def random_shares(sweep_seed: int, number: int, dimensions: int) -> list[float]:
    """Return the probabilities at which a random design takes the values of a run, whatever the number of runs."""
    source = random.Random(f"{sweep_seed}/{number}/factors")  # noqa: S311 - no secret
    return [source.random() for _ in range(dimensions)]


def configuration_of(sweep_seed: int, number: int, values: Mapping[str, object]) -> Configuration:
    """Return a configuration; where `seed` is no factor, it has a seed of its own."""
    given = values.get("seed")
    seed = given if isinstance(given, int) else run_seed(sweep_seed, number)
    return Configuration(number=number, seed=seed, values=values)


def _even_points(
    design: Literal["latin_hypercube", "sobol"], dimensions: int, count: int, seed: int
) -> list[list[float]]:
    # It takes a second to load, which no other design needs.
    from scipy.stats import qmc

    if design == "latin_hypercube":
        return qmc.LatinHypercube(dimensions, rng=seed).random(count).tolist()
    # Drawn by the power of two, as its balance needs it: a longer sweep then starts with a shorter one.
    engine = qmc.Sobol(dimensions, scramble=True, rng=seed)
    return engine.random(2 ** math.ceil(math.log2(count))).tolist()[:count]


def _grid(factors: Mapping[str, Factor], runs: int) -> Iterator[tuple[int, dict[str, object]]]:
    rows = [dict(zip(factors, row, strict=True)) for row in itertools.product(*map(levels, factors.values()))]
    return itertools.islice(enumerate(itertools.cycle(rows)), runs)


def _read_points(sweep: Sweep, name: str) -> Iterator[dict[str, object]]:
    file = Path(sweep.resolve(name))
    where = sweep.source.position(("design", "csv"))
    try:
        with file.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.reader(stream, strict=True))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DocumentError(f"the design {file} cannot be read: {error}", where=where, hint="a CSV file") from error
    if not rows:
        raise DocumentError(f"the design {file} is empty", where=where, hint="a header row with addresses of factors")
    header = [cell.strip() for cell in rows[0]]
    for address in header:
        require_address(address, where=f"{file}:1")
    missing = [address for address in sweep.document.factors if address not in header]
    if missing:
        raise DocumentError(f"the design {file} has no column `{missing[0]}`", where=f"{file}:1", hint="add it")
    for number, row in enumerate(rows[1:], start=2):
        if not any(cell.strip() for cell in row):
            continue
        if len(row) != len(header):
            raise DocumentError(f"{len(row)} values for {len(header)} columns", where=f"{file}:{number}")
        yield dict(zip(header, map(_value, row), strict=True))


def _value(text: str) -> object:
    """Return a cell of a CSV file: JSON where it is some, else text."""
    try:
        return msgspec.json.decode(text.strip())
    except msgspec.DecodeError:
        return text.strip()
