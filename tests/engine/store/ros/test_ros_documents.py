"""Data of ReconCycle in the shape of `mongodb_store` becomes entries, and entries become such data."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import bson
import pymongo
import pytest

from engine.errors import StoreError
from engine.skills.entries import EntryRecord
from engine.store import STANDARD_KINDS, verified_value
from engine.store.mongo.mongo_collection import read_collection
from engine.store.ros.ros_documents import RosEntry, entries_from_ros, ros_document
from engine.store.ros.ros_import import MAX_DOCUMENTS, MAX_FILE, read_ros_file
from tests.engine.store.mongod import Mongod
from tests.engine.store.stores import database_of

STAMP = {"secs": 1650000000, "nsecs": 250000000}
HEADER: dict[str, Any] = {"seq": 7, "stamp": STAMP, "frame_id": "panda_1/panda_1_link0"}
NAMES = [f"panda_joint{n}" for n in range(1, 8)]


def stored(name: str, ros_type: str, message: dict[str, Any], **meta: object) -> dict[str, Any]:
    """A document as `insert_named` of mongodb_store writes it."""
    package, kind = ros_type.split("/")
    return {
        **message,
        "_meta": {
            "name": name,
            "stored_type": ros_type,
            "stored_class": f"{package}.msg._{kind}.{kind}",
            "inserted_by": "/helping_hand_services",
            **meta,
        },
    }


def joint_state(*position: float, names: list[str] | None = None) -> dict[str, Any]:
    """A sensor_msgs/JointState."""
    return {
        "header": HEADER,
        "name": names or [],
        "position": list(position),
        "velocity": [math.nan] * len(position),
        "effort": [],
    }


def axes(names: str, *values: float) -> dict[str, float]:
    """A geometry_msgs vector or quaternion."""
    return dict(zip(names, values, strict=True))


POSE: dict[str, Any] = {"position": axes("xyz", 0.4, 0.1, 0.3), "orientation": axes("xyzw", 1.0, 0.0, 0.0, 0.0)}
GAINS: dict[str, Any] = {
    "a_z": 48.0,
    "b_z": 12.0,
    "a_x": 2.0,
    "d_t": 0.01,
    "id": 3,
    "tau": 1.5,
    "N": 2,
    "c": [1.0, 0.4],
    "sigma": [0.1, 0.2],
}
JOINT_DMP: dict[str, Any] = {
    "header": HEADER,
    **GAINS,
    "y0": {**joint_state(0.1, 0.2), "velocity": []},
    "goal": joint_state(0.3, 0.4),
    "w": [{"data": [1.0, 2.0]}, {"data": [3.0, 4.0]}],
}
CART_DMP: dict[str, Any] = {
    "header": HEADER,
    **GAINS,
    "p0": POSE,
    "goal": POSE,
    "dp0": {"linear": axes("xyz", 0.1, 0.0, 0.0), "angular": axes("xyz", 0.0, 0.0, 0.2)},
    "w": [{"data": [float(row), 0.0]} for row in range(6)],
}


def one(document: dict[str, Any]) -> RosEntry:
    """The entry of one document."""
    (entry,) = entries_from_ros([document])
    return entry


@pytest.mark.parametrize(
    ("ros_type", "message", "kind", "value"),
    [
        (
            "sensor_msgs/JointState",
            joint_state(0.1, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8, names=NAMES),
            "joints",
            {"joints": [0.1, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8], "names": NAMES},
        ),
        ("geometry_msgs/Pose", POSE, "pose", {"xyz": [0.4, 0.1, 0.3], "xyzw": [1, 0, 0, 0], "frame": "world"}),
        (
            "geometry_msgs/PoseStamped",
            {"header": HEADER, "pose": POSE},
            "pose",
            {"xyz": [0.4, 0.1, 0.3], "xyzw": [1, 0, 0, 0], "frame": "panda_1/panda_1_link0"},
        ),
        (
            "geometry_msgs/TransformStamped",
            {
                "header": HEADER,
                "child_frame_id": "pick",
                "transform": {"translation": POSE["position"], "rotation": POSE["orientation"]},
            },
            "pose",
            {"xyz": [0.4, 0.1, 0.3], "xyzw": [1, 0, 0, 0], "frame": "panda_1/panda_1_link0"},
        ),
        (
            "robot_module_msgs/JointSpaceDMP",
            JOINT_DMP,
            "dmp",
            {
                "N": 2,
                "a_z": 48.0,
                "a_x": 2.0,
                "tau": 1.5,
                "id": 3,
                "c": [1.0, 0.4],
                "sigma": [0.1, 0.2],
                "y0": [0.1, 0.2],
                "dy0": [0.0, 0.0],
                "goal": [0.3, 0.4],
                "w": [[1.0, 2.0], [3.0, 4.0]],
            },
        ),
        (
            "trajectory_msgs/JointTrajectory",
            {
                "header": HEADER,
                "joint_names": ["a", "b"],
                "points": [
                    {"positions": [0.1 * n, 0.2], "time_from_start": {"secs": n, "nsecs": 500_000_000}} for n in (0, 1)
                ],
            },
            "trajectory",
            {"times_s": [0.5, 1.5], "joints": [[0.0, 0.2], [0.1, 0.2]], "names": ["a", "b"]},
        ),
    ],
)
def test_a_message_of_reconcycle_becomes_an_entry_of_its_kind(
    ros_type: str, message: dict[str, Any], kind: str, value: dict[str, Any]
) -> None:
    """Names, units and the order of quaternions are those of ROS."""
    entry = one(stored("left_home", ros_type, message))
    assert (entry.record, entry.kept) == (EntryRecord(kind=kind, name="left_home", value=value, revision=0), "")


def test_a_cartesian_primitive_becomes_one() -> None:
    """Six rows of weights, start and goal as poses, the speed at the start, the frame of its header."""
    value = one(stored("pour", "robot_module_msgs/CartesianSpaceDMP", CART_DMP)).record.value
    assert (value["y0"], value["dy0"]) == ([0.4, 0.1, 0.3, 1.0, 0.0, 0.0, 0.0], [0.1, 0.0, 0.0, 0.0, 0.0, 0.2])
    assert (value["w6"], value["frame"]) == ([5.0, 0.0], "panda_1/panda_1_link0")


def test_ros_2_documents_have_the_message_in_a_field_of_its_own() -> None:
    """And types with `/msg/`, and `n` and `sec` for `N` and `secs`."""
    message = {key: value for key, value in JOINT_DMP.items() if key != "N"} | {"n": 2}
    document = {"message": message, "_meta": {"name": "lift", "stored_type": "robot_module_msgs/msg/JointSpaceDMP"}}
    entry = one(document)
    assert (entry.record.kind, entry.record.value["N"]) == ("dmp", 2)


def test_a_message_of_another_type_stays_a_record() -> None:
    """Nothing is lost."""
    entry = one(stored("flag", "std_msgs/Bool", {"data": True}))
    assert entry.record.kind == "record"
    assert entry.record.value == {"ros_type": "std_msgs/Bool", "message": {"data": True}}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"b_z": 5.0}, "b_z is 5, but flexcell requires a_z / 4 = 12"),
        ({"w": [{"data": [1.0]}]}, "w has 1 values, not 2"),
        ({"c": None}, "NoneType"),
        ({"tau": -1.0}, "tau"),
    ],
)
def test_a_primitive_that_is_none_here_is_kept_as_a_record_with_the_reason(change: dict[str, Any], says: str) -> None:
    """The reader decides what to make of it."""
    entry = one(stored("lift", "robot_module_msgs/JointSpaceDMP", {**JOINT_DMP, **change}))
    assert entry.record.kind == "record"
    assert says in entry.kept


def test_of_several_documents_with_one_name_the_last_counts() -> None:
    """As a query of mongodb_store would answer."""
    documents = [stored("home", "sensor_msgs/JointState", joint_state(float(n))) for n in range(3)]
    assert one_of(documents) == [("home", [2.0])]


def one_of(documents: list[dict[str, Any]]) -> list[tuple[str, object]]:
    """Name and joints of each entry."""
    return [(entry.record.name, entry.record.value["joints"]) for entry in entries_from_ros(documents)]


def test_names_that_are_none_here_are_changed_and_collisions_refused() -> None:
    """`Home 1` and `2nd` are said with their new names; two that become one are not mixed up."""
    documents = [stored(name, "sensor_msgs/JointState", joint_state(1.0)) for name in ("Home 1", "2nd")]
    assert [entry.record.name for entry in entries_from_ros(documents)] == ["home_1", "n2nd"]
    with pytest.raises(StoreError, match="document 2: the names 'Home 1' and 'home_1' both become 'home_1'"):
        entries_from_ros([documents[0], stored("home_1", "sensor_msgs/JointState", joint_state(2.0))])


def test_a_document_that_is_no_named_entry_is_refused_by_number() -> None:
    """Such as one of another collection."""
    with pytest.raises(StoreError, match=r"document 2: the document has no `_meta` with `name` and `stored_type`"):
        entries_from_ros([stored("a", "std_msgs/Bool", {"data": True}), {"x": 1}])


@pytest.mark.parametrize(
    "record",
    [
        EntryRecord(kind="joints", name="home", value={"joints": [1.0, 2.0], "names": ["a", "b"]}, revision=4),
        EntryRecord(
            kind="pose", name="pick", value={"xyz": [1, 2, 3], "xyzw": [0, 0, 0, 1], "frame": "tray"}, revision=1
        ),
        one(stored("lift", "robot_module_msgs/JointSpaceDMP", JOINT_DMP)).record,
        one(stored("pour", "robot_module_msgs/CartesianSpaceDMP", CART_DMP)).record,
        EntryRecord(kind="record", name="tray", value={"rows": 4, "nested": {"x": [1, None, "ü"]}}, revision=2),
        EntryRecord(
            kind="trajectory",
            name="t",
            value={"times_s": [0.0, 1.0], "joints": [[1.0], [2.0]], "names": []},
            revision=1,
        ),
    ],
    ids=lambda record: record.kind,
)
def test_what_is_exported_is_imported_again_as_it_was(record: EntryRecord) -> None:
    """Through the JSON lines of mongoexport."""
    again = one(json.loads(json.dumps(ros_document(record)))).record
    typed = [verified_value(STANDARD_KINDS, each.kind, each.value, where="x") for each in (again, record)]
    assert (again.kind, again.name, typed[0]) == (record.kind, record.name, typed[1])


@pytest.mark.parametrize("form", ["lines", "array", "canonical", "bson"])
def test_files_of_mongoexport_and_mongodump_are_read(form: str, tmp_path: Path) -> None:
    """JSON lines, one array, canonical extended JSON, BSON."""
    documents = [stored(f"e{n}", "sensor_msgs/JointState", {**joint_state(float(n)), "velocity": []}) for n in range(3)]
    file = tmp_path / ("dump.bson" if form == "bson" else "dump.json")
    if form == "bson":
        file.write_bytes(b"".join(bson.encode({"_id": bson.ObjectId(), **document}) for document in documents))
    elif form == "array":
        file.write_text(json.dumps(documents, indent=1))
    else:
        lines = [json.dumps({"_id": {"$oid": "65" * 12}, **document}) for document in documents]
        if form == "canonical":
            lines = [line.replace(f"[{n}.0]", f'[{{"$numberDouble": "{n}.0"}}]') for n, line in enumerate(lines)]
            lines = [line.replace('"seq": 7', '"seq": {"$numberInt": "7"}') for line in lines]
        file.write_text("\n".join(lines) + "\n")
    assert one_of(list(read_ros_file(file))) == [("e0", [0.0]), ("e1", [1.0]), ("e2", [2.0])]


@pytest.mark.parametrize("text", ["{", "[1]", '{"a": 1} x', "\x00"])
def test_a_file_that_is_no_export_is_refused_with_its_path(text: str, tmp_path: Path) -> None:
    """With what is due."""
    (tmp_path / "dump.json").write_text(text)
    with pytest.raises(
        StoreError, match=r"dump\.json: the documents cannot be read: .* \(give the output of mongoexport"
    ):
        read_ros_file(tmp_path / "dump.json")


def test_the_database_of_mongodb_store_is_read_from_its_server(replicated_mongo: Mongod, tmp_path: Path) -> None:
    """As the package writes it: a database `message_store`, a collection of the same name."""
    database = database_of(tmp_path)
    client: pymongo.MongoClient[dict[str, Any]] = pymongo.MongoClient(replicated_mongo.uri)
    with client:
        client[database]["message_store"].insert_many(
            [
                stored("home", "sensor_msgs/JointState", joint_state(1.0)),
                stored("lift", "robot_module_msgs/JointSpaceDMP", JOINT_DMP),
            ]
        )
        found = entries_from_ros(read_collection(f"{replicated_mongo.uri}/{database}", collection="message_store"))
        client.drop_database(database)
    assert [(entry.record.kind, entry.record.name, entry.kept) for entry in found] == [
        ("joints", "home", ""),
        ("dmp", "lift", ""),
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[" * 100_000, "recursion"),
        ('{"_meta": {"name": "a", "stored_type": "b/C"}, "x": ' + "[" * 70 + "]" * 70 + "}", "deeper than 64 levels"),
        ('{"x": {"$numberInt": ["1"]}}', "int"),
        ('{"x": {"$numberInt": "' + "9" * 10_000 + '"}}', "digits"),
        ("{}" * (MAX_DOCUMENTS + 1), f"more than {MAX_DOCUMENTS} documents"),
        ("[1]", "1 is not a document"),
    ],
)
def test_a_file_that_holds_too_much_is_refused(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "x.json").write_text(text, encoding="utf-8")
    with pytest.raises(StoreError, match=rf"x\.json: the documents cannot be read: .*{said}"):
        read_ros_file(tmp_path / "x.json")


def test_a_file_that_is_mostly_a_hole_is_refused(tmp_path: Path) -> None:
    with (tmp_path / "x.bson").open("wb") as stream:
        stream.truncate(MAX_FILE + 1)
    with pytest.raises(StoreError, match=f"more than {MAX_FILE} bytes"):
        read_ros_file(tmp_path / "x.bson")


@pytest.mark.parametrize("meta", ["text", 7, ["a"], {"name": "a", "stored_type": "b/C", "flexcell": "text"}])
def test_a_document_whose_meta_is_something_else_is_no_accident(meta: object) -> None:
    document = {"_meta": meta, "message": {"x": 1}}
    if isinstance(meta, dict):
        assert entries_from_ros([document])[0].record.kind == "record"
    else:
        with pytest.raises(StoreError, match="the document has no `_meta`"):
            entries_from_ros([document])
