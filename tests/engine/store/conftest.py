"""Gives the tests of the store real MongoDB servers, one of each mode for all tests of a process."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.engine.store.mongod import RUNS_HERE, Mongod


def _server(factory: pytest.TempPathFactory, *, replicated: bool) -> Iterator[Mongod]:
    if not RUNS_HERE:
        pytest.skip("the MongoDB server of the tests runs on Linux x86-64 only")
    server = Mongod(replicated=replicated, folder=factory.mktemp("mongod"))
    try:
        server.start()
        yield server
    finally:
        server.remove()


@pytest.fixture(scope="session")
def replicated_mongo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mongod]:
    """A replica set of one server."""
    yield from _server(tmp_path_factory, replicated=True)


@pytest.fixture(scope="session")
def standalone_mongo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mongod]:
    """A server without a replica set, and so without transactions."""
    yield from _server(tmp_path_factory, replicated=False)
