"""Rows of several events: all come back, and a changed byte is traced to its event."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import JournalError
from engine.event import AnyEvent, MessageLogged
from engine.journal.event_block import MAX_BYTES, MAX_EVENTS, EventBlock, new_blocks
from tests.engine.journal.test_codec import EVENTS

START = b"s" * 16


def logged(seq: int, message: str = "x") -> MessageLogged:
    return MessageLogged(seq=seq, time_s=0.0, path="root", level="info", message=message)


def numbered(events: list[AnyEvent]) -> list[AnyEvent]:
    return [msgspec.structs.replace(event, seq=seq) for seq, event in enumerate(events, 5)]


@given(st.lists(EVENTS, min_size=1, max_size=8).map(numbered))
def test_events_come_back_as_they_were(events: list[AnyEvent]) -> None:
    (block,) = new_blocks("run", 1, events, START)
    assert list(block.events()) == events
    assert (block.seq, block.last) == (5, 4 + len(events))
    assert block.chained(START) == block.checksum != block.chained(b"t" * 16)


@given(st.lists(EVENTS, min_size=1, max_size=8).map(numbered), st.data())
def test_a_changed_byte_is_traced_to_its_event(events: list[AnyEvent], choice: st.DataObject) -> None:
    (block,) = new_blocks("run", 1, events, START)
    at = choice.draw(st.integers(0, len(block.data) - 1))
    flipped = block.data[at] ^ choice.draw(st.integers(1, 255))
    damaged = msgspec.structs.replace(block, data=block.data[:at] + bytes([flipped]) + block.data[at + 1 :])
    seq = 5 + block.data[:at].count(b"\n")
    assert damaged.chained(START) != damaged.checksum
    assert damaged.suspects() == (seq, seq)


def test_where_the_sums_accuse_none_all_events_are_suspects() -> None:
    (block,) = new_blocks("run", 1, [logged(1), logged(2)], START)
    assert msgspec.structs.replace(block, epoch=2).suspects() == (1, 2)


def test_many_events_are_many_blocks_in_one_chain() -> None:
    events = [logged(seq) for seq in range(1, 3 * MAX_EVENTS)]
    blocks = list(new_blocks("run", 1, events, START))
    assert [block.last - block.seq + 1 for block in blocks] == [MAX_EVENTS, MAX_EVENTS, MAX_EVENTS - 1]
    assert _read(blocks) == events


def test_large_events_share_a_block_only_up_to_its_size() -> None:
    """What one commit had written as rows of their own must not become one row that SQLite refuses."""
    sizes = (MAX_BYTES // 3, MAX_BYTES // 3, MAX_BYTES // 3, 10, 2 * MAX_BYTES, 10, 10)
    events = [logged(seq, "m" * size) for seq, size in enumerate(sizes, 1)]
    blocks = list(new_blocks("run", 1, events, START))
    assert [(block.seq, block.last) for block in blocks] == [(1, 2), (3, 4), (5, 5), (6, 7)]
    assert _read(blocks) == events


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b'{"event":"log"}\n', "event 1 of the block: this is not an event"),
        (b"", "the block does not hold the events 1 to 2"),
        (msgspec.json.Encoder().encode_lines([logged(1), logged(3)]), "the block does not hold the events 1 to 2"),
    ],
)
def test_a_row_with_the_right_checksum_may_hold_no_events_all_the_same(data: bytes, message: str) -> None:
    """Who makes a file on purpose can make checksums too; it is told, and nothing breaks."""
    with pytest.raises(JournalError, match=message):
        EventBlock("run", 1, 2, 1, b"", data, b"").events()


def _read(blocks: list[EventBlock]) -> list[AnyEvent]:
    chain, events = START, list[AnyEvent]()
    for block in blocks:
        assert block.checksum == block.chained(chain)
        chain = block.checksum
        events += block.events()
    return events
