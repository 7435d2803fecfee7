"""The states that read and write named entries."""

from __future__ import annotations

import pytest

from engine.errors import Cause, EntryConflict, EntryNotFound, StoreError
from engine.skills import entries
from engine.skills.entries import EntryRecord
from engine.state import Outcome
from states.store.read_entry import ReadEntry
from states.store.write_entry import WriteEntry
from tests.states.fake_context import FakeContext

RECORD = EntryRecord(kind="record", name="count", value={"n": 4}, revision=7)
MISSING = EntryNotFound("there is no record entry called count", where="store", hint="did you mean counts?")
STALE = EntryConflict("revision 7 is there, revision 6 was expected", where="record count")


async def test_a_found_entry_comes_out_with_its_revision() -> None:
    """Value and revision go to userdata."""
    ctx = FakeContext({"store/read_entry": RECORD})
    outcome = await ReadEntry(kind="record", name="count").run(ctx)
    assert outcome == Outcome("found", {"value": {"n": 4}, "revision": 7})
    assert ctx.sent == [("store/read_entry", entries.ReadEntry(kind="record", name="count"))]


async def test_a_missing_entry_is_an_outcome_that_names_it() -> None:
    """The store's own words are at the root of the chain."""
    outcome = await ReadEntry(kind="record", name="count").run(FakeContext({"store/read_entry": MISSING}))
    root = Cause(
        message="there is no record entry called count (did you mean counts?)", where="store", kind="EntryNotFound"
    )
    assert outcome == Outcome(
        "missing",
        cause=Cause(
            message="record entry count cannot be read", where="root/step", kind="store.ReadEntry", because=root
        ),
    )


async def test_a_failing_store_is_an_error_and_no_outcome() -> None:
    """A broken disk is not "missing"."""
    with pytest.raises(StoreError, match="disk"):
        await ReadEntry(kind="record", name="count").run(FakeContext({"store/read_entry": StoreError("disk is gone")}))


async def test_a_value_is_written_as_given() -> None:
    """The request carries the value and the expected revision."""
    ctx = FakeContext({"store/write_entry": RECORD})
    outcome = await WriteEntry(kind="record", name="count").run(ctx, value={"n": 4}, expected_revision=6)
    assert outcome == Outcome("written", {"revision": 7})
    request = entries.WriteEntry(kind="record", name="count", value={"n": 4}, expected_revision=6)
    assert ctx.sent == [("store/write_entry", request)]


async def test_a_write_that_lost_the_race_is_a_conflict() -> None:
    """Somebody else's revision is there: the behavior can handle that."""
    ctx = FakeContext({"store/write_entry": STALE})
    outcome = await WriteEntry(kind="record", name="count").run(ctx, value={}, expected_revision=6)
    assert outcome.name == "conflict"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "record entry count was changed by another writer",
        "revision 7 is there, revision 6 was expected",
    ]


@pytest.mark.parametrize("expected", [None, 7])
async def test_a_refused_value_is_an_error_and_no_conflict(expected: int | None) -> None:
    """Only a conflict is an outcome."""
    ctx = FakeContext({"store/write_entry": StoreError("this is no pose")})
    with pytest.raises(StoreError, match="this is no pose"):
        await WriteEntry(kind="record", name="count").run(ctx, value={}, expected_revision=expected)
