"""The store: named entries (joint configurations, poses, DMPs, records) behind one interface.

`SqliteStore.open(path)` is the embedded default, `open_store(address)` also opens a store on a MongoDB
server (which needs pymongo); `register_store` serves a store on the bus.
"""

from engine.messages.demonstrations import Trajectory
from engine.messages.detection_template import DetectionTemplate, TemplateImage
from engine.messages.primitives import CartDmp, CartOffsets, JointDmp
from engine.skills.gripper import GripperSetting
from engine.store.contract import ChangeListener, EntryChange, EntryKey, Store, Value
from engine.store.entry_kinds import RECORD, STANDARD_KINDS, EntryKind, Joints, decode_entry, verified_value
from engine.store.entry_services import publish_changes, register_store
from engine.store.limits import verify_name
from engine.store.migration import Migration, migrate
from engine.store.sqlite.sqlite_store import SqliteStore
from engine.store.store_factory import open_store

__all__ = [
    "RECORD",
    "STANDARD_KINDS",
    "CartDmp",
    "CartOffsets",
    "ChangeListener",
    "DetectionTemplate",
    "EntryChange",
    "EntryKey",
    "EntryKind",
    "GripperSetting",
    "JointDmp",
    "Joints",
    "Migration",
    "SqliteStore",
    "Store",
    "TemplateImage",
    "Trajectory",
    "Value",
    "decode_entry",
    "migrate",
    "open_store",
    "publish_changes",
    "register_store",
    "verified_value",
    "verify_name",
]
