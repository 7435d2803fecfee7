"""The store: named entries (joint configurations, poses, DMPs, records) behind one contract.

`SqliteStore.open(path)` is the embedded default, `open_store(address)` also opens one on a MongoDB
server (which needs pymongo); `register_store` puts a store on the bus.
"""

from engine.demonstration import Trajectory
from engine.detection_template import DetectionTemplate, TemplateImage
from engine.primitive import CartDmp, CartOffsets, JointDmp
from engine.skills.gripper import GripperAction
from engine.store.contract import ChangeListener, EntryChange, EntryKey, Store, Value
from engine.store.kinds import RECORD, STANDARD_KINDS, EntryKind, Joints, read_as, verified_value
from engine.store.migration import Migration, migrate
from engine.store.opening import open_store
from engine.store.skills import publish_changes, register_store
from engine.store.sqlite import SqliteStore

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
    "GripperAction",
    "JointDmp",
    "Joints",
    "Migration",
    "SqliteStore",
    "Store",
    "TemplateImage",
    "Trajectory",
    "Value",
    "migrate",
    "open_store",
    "publish_changes",
    "read_as",
    "register_store",
    "verified_value",
]
