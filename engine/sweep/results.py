"""The results of sweeps in an SQLite file: each is durable when it is counted, and is never executed twice."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Generator, Iterable, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Self

import msgspec

from engine.errors import FlexcellError
from engine.host.sqlite_file import advice, open_sqlite, read_sqlite
from engine.host.sqlite_migrations import SqliteMigrations
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult

_SCHEMA = SqliteMigrations(
    steps=(
        """
        CREATE TABLE subjects (hash TEXT PRIMARY KEY, versions TEXT NOT NULL) WITHOUT ROWID;
        CREATE TABLE results (
            key TEXT PRIMARY KEY, subject TEXT NOT NULL REFERENCES subjects (hash), saved_unix_s REAL NOT NULL,
            result TEXT NOT NULL
        ) WITHOUT ROWID;
        CREATE INDEX results_of_subject ON results (subject);
        """,
    )
)
_BUSY_S = 30.0
_KEYS_OF_QUERY = 500
"""A search asks for the results of a batch, and a design for all of them; SQLite limits the values of one query."""
_COSTS = {"wall_s": 0.0, "cpu_s": 0.0, "memory_bytes": 0}


class SweepResults:
    """The results in one file, of any number of sweeps; belongs to one thread, other processes may write it too.

    Args:
        path: The file.
        connection: Its open connection.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection

    @classmethod
    def open(cls, path: Path) -> Self:
        """Open or create a file.

        Raises:
            FlexcellError: it cannot be opened, or is not a file of results.
        """
        try:
            return cls(path, open_sqlite(path, schema=_SCHEMA, busy_timeout_s=_BUSY_S))
        except (sqlite3.Error, OSError) as error:
            raise _fault("opened", path, error) from error

    @classmethod
    def read(cls, path: Path) -> Self:
        """Open an existing file for reading only; any other file stays as it is.

        Raises:
            FlexcellError: it is missing, or is not a file of results.
        """
        try:
            return cls(path, read_sqlite(path, schema=_SCHEMA))
        except sqlite3.Error as error:
            raise _fault("opened", path, error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connection.close()

    def save(self, key: str, subject: str, result: TrialResult, *, replace: bool = False) -> None:
        """Save a result durably; one that is there already stays, unless it is replaced.

        Raises:
            FlexcellError: the file cannot be written; nothing is saved then.
        """
        with self._written():
            self._insert(key, subject, result, time.time(), replace=replace)

    def describe(self, subject: str, versions: Mapping[str, str]) -> None:
        """Keep the versions that the hash of a subject stands for.

        Raises:
            FlexcellError: the file cannot be written.
        """
        text = msgspec.json.encode(dict(versions), order="deterministic").decode()
        with self._written():
            self._connection.execute("INSERT OR IGNORE INTO subjects VALUES (?, ?)", (subject, text))

    def subjects(self) -> dict[str, dict[str, str]]:
        """Return the versions of each subject by its hash."""
        rows = self._read("SELECT hash, versions FROM subjects ORDER BY hash")
        return {str(row[0]): msgspec.json.decode(str(row[1]), type=dict[str, str]) for row in rows}

    def saved_unix_s(self, subject: str) -> float:
        """Return when the last result of a subject was saved, in Unix time; 0 without any."""
        ((latest,),) = self._read("SELECT max(saved_unix_s) FROM results WHERE subject = ?", subject)
        return float(str(latest or 0.0))

    def of(self, subject: str, keys: Iterable[str]) -> dict[str, TrialResult]:
        """Return the saved results of a subject that have one of these keys.

        Raises:
            FlexcellError: the file cannot be read or is damaged.
        """
        asked = list(keys)
        found: dict[str, TrialResult] = {}
        for start in range(0, len(asked), _KEYS_OF_QUERY):
            some = asked[start : start + _KEYS_OF_QUERY]
            places = ", ".join("?" * len(some))
            query = f"SELECT key, result FROM results WHERE subject = ? AND key IN ({places})"  # noqa: S608 - marks
            found |= {str(key): self._decoded(key, text) for key, text in self._read(query, subject, *some)}
        return found

    def of_design(
        self, subject: str, configurations: Iterable[Configuration], *, again: bool = False
    ) -> dict[int, TrialResult]:
        """Return the saved results of configurations by the number that each has in its design.

        Args:
            subject: The hash of what they have in common.
            configurations: The configurations.
            again: Whether those whose process crashed or hung are left out, because they are to be executed again.

        Raises:
            FlexcellError: the file cannot be read or is damaged.
        """
        keys = {each.key(subject): each for each in configurations}
        return {
            keys[key].number: msgspec.structs.replace(result, configuration=keys[key])
            for key, result in self.of(subject, keys).items()
            if not (again and result.broken)
        }

    def all_of(self, subject: str) -> list[TrialResult]:
        """Return all results of a subject.

        Raises:
            FlexcellError: the file cannot be read or is damaged.
        """
        rows = self._read("SELECT key, result FROM results WHERE subject = ? ORDER BY key", subject)
        return [self._decoded(key, text) for key, text in rows]

    def merge(self, others: Iterable[Path]) -> int:
        """Add the results of other files and return how many were new.

        Raises:
            FlexcellError: a file cannot be read or this one not written; or two files have different results of the
                same configuration of the same versions.
        """
        added = 0
        for path in others:
            if not path.is_file():
                raise FlexcellError("there is no such file", where=path, hint="give the files of `--results`")
            with type(self).open(path) as other:
                for subject, versions in other.subjects().items():
                    self.describe(subject, versions)
                added += self._add_all(other)
        return added

    def _add_all(self, other: SweepResults) -> int:
        ours = {str(key): text for key, text in self._read("SELECT key, result FROM results")}
        added = 0
        with self._written():
            for key, subject, saved_unix_s, text in other._read(
                "SELECT key, subject, saved_unix_s, result FROM results ORDER BY key"
            ):
                result, known = other._decoded(key, text), ours.get(str(key))
                if known is None:
                    self._insert(str(key), str(subject), result, float(str(saved_unix_s)), replace=False)
                    added += 1
                elif without_costs(self._decoded(key, known)) != without_costs(result):
                    raise FlexcellError(
                        f"configuration {result.configuration.number} has ended differently in {self.path}",
                        where=other.path,
                        hint="a result depends on the machine: run `flexcell sweep rerun` on both",
                    )
        return added

    def _insert(self, key: str, subject: str, result: TrialResult, unix_s: float, *, replace: bool) -> None:
        verb = "REPLACE" if replace else "IGNORE"
        self._connection.execute(
            f"INSERT OR {verb} INTO results VALUES (?, ?, ?, ?)",  # noqa: S608 - two words of our own
            (key, subject, unix_s, msgspec.json.encode(result).decode()),
        )

    def _decoded(self, key: object, text: object) -> TrialResult:
        try:
            return msgspec.json.decode(str(text), type=TrialResult)
        except msgspec.DecodeError as error:
            raise FlexcellError(
                f"the result {key} is damaged: {error}", where=self.path, hint="restore a copy or move it away"
            ) from error

    def _read(self, query: str, *values: object) -> list[tuple[object, ...]]:
        try:
            return self._connection.execute(query, values).fetchall()
        except sqlite3.Error as error:
            raise _fault("read", self.path, error) from error

    @contextmanager
    def _written(self) -> Generator[None]:
        try:
            self._connection.execute("BEGIN IMMEDIATE")
            yield
            self._connection.execute("COMMIT")
        except sqlite3.Error as error:
            raise _fault("written", self.path, error) from error
        finally:
            if self._connection.in_transaction:
                self._connection.rollback()


def without_costs(result: TrialResult) -> TrialResult:
    """Return a result as it is on every machine: without times and memory of the computer."""
    number = msgspec.structs.replace(result.configuration, number=0)
    return msgspec.structs.replace(result, configuration=number, **_COSTS)


def _fault(what: str, path: Path, error: sqlite3.Error | OSError) -> FlexcellError:
    return FlexcellError(f"results cannot be {what}: {error}", where=path, hint=advice(error))
