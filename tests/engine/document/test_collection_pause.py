"""The collector pauses while documents are read, on any number of threads, and goes on afterwards."""

from __future__ import annotations

import gc
import threading
import weakref

from engine.document.collection_pause import FULL_EVERY, collection_paused, without_collection


class Cycle:
    """Needs the collector to go."""

    def __init__(self) -> None:
        self.itself = self


def test_the_collector_goes_on_after_the_last_one() -> None:
    """Two threads overlap; the first to end leaves it paused."""
    inside, done = threading.Event(), threading.Event()

    def work() -> None:
        with collection_paused():
            inside.set()
            done.wait()

    thread = threading.Thread(target=work)
    with collection_paused():
        thread.start()
        inside.wait()
    assert not gc.isenabled()
    done.set()
    thread.join()
    assert gc.isenabled()


def test_a_function_that_raises_leaves_it_on() -> None:
    """And hands its error on."""

    @without_collection
    def fail(message: str) -> None:
        raise ValueError(f"{message} {gc.isenabled()}")

    try:
        fail("enabled:")
    except ValueError as error:
        said = str(error)
    else:
        said = ""
    assert (said, gc.isenabled()) == ("enabled: False", True)


def test_a_pause_keeps_no_garbage_that_was_there_before() -> None:
    """What grows old with the document would be looked at only much later."""
    left = weakref.ref(Cycle())
    with collection_paused():
        pass
    assert left() is None


def test_what_becomes_garbage_when_it_is_old_goes_in_the_end() -> None:
    """Pauses in a row start the counts of the collector anew; 10,000 readings with runs between them kept 250 MB."""
    held = [Cycle()]
    left = weakref.ref(held[0])
    with collection_paused():
        pass
    held.clear()
    for _ in range(FULL_EVERY):
        with collection_paused():
            pass
    assert left() is None
