"""Who gets to a MongoDB server, and what those hear who do not."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pymongo
import pytest
from pymongo.errors import DocumentTooLarge, OperationFailure, PyMongoError

from engine.errors import StoreError
from engine.store import open_store
from engine.store.mongo.mongo_address import public_address, with_environment
from engine.store.mongo.mongo_errors import translate_mongo_errors
from engine.store.mongo.mongo_server import verify_version
from engine.store.mongo.mongo_store import MongoStore
from engine.store.store_factory import split_database
from tests.engine.store.mongod import RUNS_HERE, Mongod
from tests.engine.store.old_server import OldServer
from tests.engine.store.stores import database_of

PASSWORD = "p@ss:w/rd %"


@pytest.fixture(scope="module")
def guarded_mongo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mongod]:
    """A server that asks for credentials: `writer` may write, `reader` may only read."""
    if not RUNS_HERE:
        pytest.skip("the MongoDB server of the tests runs on Linux x86-64 only")
    server = Mongod(replicated=False, folder=tmp_path_factory.mktemp("guarded"), options=("--auth",))
    server.start()
    client: pymongo.MongoClient[dict[str, Any]] = pymongo.MongoClient(server.uri)
    with client:
        roles = ["userAdminAnyDatabase", "readWriteAnyDatabase"]
        client.admin.command("createUser", "writer", pwd=PASSWORD, roles=roles)
    admin: pymongo.MongoClient[dict[str, Any]] = pymongo.MongoClient(
        "127.0.0.1", server.port, username="writer", password=PASSWORD
    )
    with admin:
        admin.admin.command("createUser", "reader", pwd="r", roles=["readAnyDatabase"])
    yield server
    server.remove()


async def test_a_password_comes_from_the_environment(
    guarded_mongo: Mongod, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever characters it has; and it shows nowhere."""
    monkeypatch.setenv("CELL_PASSWORD", PASSWORD)
    uri = f"mongodb://writer:${{CELL_PASSWORD}}@127.0.0.1:{guarded_mongo.port}"
    async with MongoStore.open(uri, database=database_of(tmp_path)) as store:
        assert (await store.put("record", "a", {})).revision == 1
        assert store.address == f"mongodb://127.0.0.1:{guarded_mongo.port}/{database_of(tmp_path)}"


@pytest.mark.parametrize(
    ("login", "says"),
    [
        ("writer:wrong@", "the server refuses the credentials of the user writer (check user, password"),
        ("", "an anonymous client (no user is given) has no permission: "),
        ("reader:r@", "the user reader has no permission: "),
    ],
)
def test_whoever_may_not_write_is_reported_by_name(guarded_mongo: Mongod, login: str, says: str) -> None:
    """Wrong password, no credentials, a role too small."""
    with pytest.raises(StoreError) as refusal:
        MongoStore.open(f"mongodb://{login}127.0.0.1:{guarded_mongo.port}")
    assert f"mongodb://127.0.0.1:{guarded_mongo.port}/flexcell: the store cannot be " in str(refusal.value)
    assert says in str(refusal.value)
    assert "wrong" not in str(refusal.value)


def test_a_server_that_is_not_there_is_reported_with_address_and_advice() -> None:
    """Within the patience, not after the half minute that the driver waits by default."""
    with pytest.raises(
        StoreError,
        match=r"mongodb://127\.0\.0\.1:1/flexcell: the store cannot be opened: the server cannot be reached: "
        r"127\.0\.0\.1:1: .*Connection refused \(check that mongod runs there",
    ):
        MongoStore.open("mongodb://127.0.0.1:1", patience_s=0.3)


async def test_a_server_too_old_for_the_driver_is_reported_so() -> None:
    """Of MongoDB 3.6."""
    async with OldServer() as server:
        with pytest.raises(StoreError, match=r"the server is too old \(use MongoDB 5\.0 or newer\)"):
            await asyncio.to_thread(MongoStore.open, f"mongodb://127.0.0.1:{server.port}", patience_s=3.0)


def test_a_server_too_old_for_any_field_name_is_reported_with_its_version() -> None:
    """The driver would take 4.4, which refuses names such as `a.b`."""
    with pytest.raises(
        StoreError, match=r"here: .* the server is MongoDB 4\.4\.29, too old \(use MongoDB 5\.0 or newer\)"
    ):
        verify_version([4, 4, 29, 0], address="here")
    verify_version([5, 0, 0, 0], address="here")


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (OperationFailure("no", 14031, {"errmsg": "No space left"}), "the disk of the server is full (free some space"),
        (DocumentTooLarge("big"), "the entry exceeds MongoDB's limit of 16 MiB (split it into several entries)"),
        (OperationFailure("no", 10334, {"errmsg": "big"}), "the entry exceeds MongoDB's limit"),
        (OperationFailure("odd", 1, {"errmsg": "odd thing"}), "odd thing (check the log of mongod)"),
        (PyMongoError("odd"), "odd (check the log of mongod)"),
    ],
)
def test_what_the_server_refuses_is_said_in_words(error: PyMongoError, says: str) -> None:
    """Errors that a test cannot provoke, told as they would be."""
    with pytest.raises(StoreError) as refusal, translate_mongo_errors("cannot be written", address="here"):
        raise error
    assert says in str(refusal.value)


@pytest.mark.parametrize("uri", ["mongodb://", "mongodb://host:port", "mongodb://h/?appname"])
def test_an_address_that_means_nothing_is_refused(uri: str) -> None:
    """Before anybody is asked."""
    with pytest.raises(StoreError):
        MongoStore.open(uri, patience_s=0.3)


def test_a_variable_that_is_not_set_is_named() -> None:
    """With the address as far as it is no secret."""
    with pytest.raises(StoreError, match=r"mongodb://h:1: the environment variable NOT_THERE is not set"):
        with_environment("mongodb://u:${NOT_THERE}@h:1", {})


@pytest.mark.parametrize(
    ("uri", "public"),
    [
        ("mongodb://u:p@h:1/db?x=y", "mongodb://h:1/flexcell"),
        ("mongodb://u:${P}@h:1", "mongodb://h:1/flexcell"),
        ("mongodb://a:1,b:2/?replicaSet=r", "mongodb://a:1,b:2/flexcell"),
        ("${ALL}", "${ALL}"),
    ],
)
def test_addresses_show_no_secret(uri: str, public: str) -> None:
    """Users, passwords and options are left out."""
    assert public_address(uri, "flexcell") == public


@pytest.mark.parametrize(
    ("uri", "split"),
    [
        ("mongodb://h:1", ("mongodb://h:1", "")),
        ("mongodb://h:1/", ("mongodb://h:1/", "")),
        ("mongodb://h:1/db", ("mongodb://h:1/", "db")),
        ("mongodb://u:p@h:1/db", ("mongodb://u:p@h:1/?authSource=db", "db")),
        ("mongodb://u:p@h:1/db?authSource=admin", ("mongodb://u:p@h:1/?authSource=admin", "db")),
    ],
)
def test_the_database_is_taken_from_the_address(uri: str, split: tuple[str, str]) -> None:
    """And one still logs in where the address says."""
    assert split_database(uri) == split


async def test_a_store_is_opened_by_what_its_address_is(replicated_mongo: Mongod, tmp_path: Path) -> None:
    """A path, or a server with a database."""
    for address in (str(tmp_path / "s.db"), f"{replicated_mongo.uri}/{database_of(tmp_path)}"):
        async with await open_store(address) as store:
            await store.put("record", "a", {})
        async with await open_store(address, inline=True) as store:
            assert [key.name for key in await store.list()] == ["a"]
            assert store.address == address


def test_the_engine_does_not_need_pymongo() -> None:
    """Importing the store, the cell and the command line imports none of it; asking for it says what is missing."""
    program = (
        "import sys; sys.modules['pymongo'] = None\n"
        "import asyncio, engine.cell.open_cell, engine.cli.main\n"
        "from engine.store import open_store\n"
        "assert not [name for name in sys.modules if name.split('.')[0] in ('bson', 'gridfs')]\n"
        "asyncio.run(open_store('mongodb://h'))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
    assert done.stderr.splitlines()[-1].startswith(
        "engine.errors.StoreError: store: a store on MongoDB needs the package"
    )
    assert done.stderr.splitlines()[-1].endswith("(pip install 'flexcell[mongo]')")
