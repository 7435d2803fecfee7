"""The collector pauses while documents are read, on any number of threads, and goes on afterwards."""

from __future__ import annotations

import gc
import threading

from engine.document.collection_pause import collection_paused, without_collection


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
