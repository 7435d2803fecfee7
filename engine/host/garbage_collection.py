"""Sets Python's cyclic garbage collector once, when a process starts; nothing switches it afterwards.

A full collection visits every object and blocks all threads, the event loop too: 0.3 s for a document of 10,000
states. By default one runs whenever a quarter more objects exist, several times while such a document is read. Most
objects of ours need none: documents have no cycles, and loaded modules stay loaded. With these thresholds young
objects are searched in steps of milliseconds, and all objects only after a million new ones.
"""

from __future__ import annotations

import gc

THRESHOLDS = (2_000, 10, 50)
"""New objects until the young ones are searched; how often until those that remained are; how often until all are."""


def set_up_collector() -> None:
    """Set the thresholds of this process; called once, before threads begin."""
    gc.set_threshold(*THRESHOLDS)


def freeze_loaded_objects(*, collect: bool = True) -> None:
    """Exclude the objects that exist now from collections, as they stay alive; with `collect` garbage goes first."""
    if collect:
        gc.collect()
    gc.freeze()
