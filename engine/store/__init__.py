"""The store: named entries (joint configurations, poses, DMPs, records) behind one contract.

`SqliteStore.open(path)` is the embedded default; `register_store` puts a store on the bus.
"""

from engine.store.contract import ChangeListener, EntryChange, EntryKey, Store, Value
from engine.store.kinds import RECORD, STANDARD_KINDS, EntryKind, JointDmp, Joints, read_as, verified_value
from engine.store.skills import register_store
from engine.store.sqlite import SqliteStore

__all__ = [
    "RECORD",
    "STANDARD_KINDS",
    "ChangeListener",
    "EntryChange",
    "EntryKey",
    "EntryKind",
    "JointDmp",
    "Joints",
    "SqliteStore",
    "Store",
    "Value",
    "read_as",
    "register_store",
    "verified_value",
]
