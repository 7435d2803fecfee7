"""Converts values of entries to and from ROS messages, with field names and units of ROS (SI)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

import msgspec

from engine.skills.entries import EntryRecord

Fields = Mapping[str, Any]
Value = dict[str, object]
_GAIN_TOLERANCE = 1e-3


def from_message(ros_type: str, message: Fields, *, kind: str = "") -> tuple[str, Value] | None:
    """Return kind and value of the entry in a message; None for a type without a kind of entry.

    Raises:
        KeyError, TypeError, ValueError: a field is missing or invalid.
    """
    if ros_type == "std_msgs/String":
        return (kind, msgspec.json.decode(message["data"], type=dict[str, object])) if kind else None
    if ros_type == "sensor_msgs/JointState":
        return "joints", {"joints": list(message["position"]), "names": list(message.get("name", ()))}
    if ros_type == "trajectory_msgs/JointTrajectory":
        return "trajectory", _trajectory(message)
    if ros_type.startswith("geometry_msgs/"):
        return _geometry(ros_type, message)
    name = ros_type.rpartition("/")[2]
    if name == "JointSpaceDMP":
        return "dmp", _joint_dmp(message)
    if name == "CartesianSpaceDMP":
        return "cart_dmp", _cart_dmp(message)
    return None


def to_message(record: EntryRecord) -> tuple[str, dict[str, Any]]:
    """Return the message type and the fields of an entry."""
    value = cast("Fields", record.value)
    if record.kind == "joints":
        return "sensor_msgs/JointState", _joint_state(value["joints"], value.get("names", ()))
    if record.kind == "pose":
        return "geometry_msgs/PoseStamped", {
            "header": _header(value.get("frame", "world")),
            "pose": _ros_pose(value["xyz"], value.get("xyzw", (0.0, 0.0, 0.0, 1.0))),
        }
    if record.kind == "dmp" and not value.get("tasktrans"):
        return "robot_module_msgs/JointSpaceDMP", {
            **_ros_dmp(value, value["w"]),
            "y0": _joint_state(value["y0"], (), value["dy0"]),
            "goal": _joint_state(value["goal"], ()),
        }
    if record.kind == "cart_dmp" and not value.get("tasktrans"):
        rows = [value[f"w{number}"] for number in range(1, 7)]
        dy0: Sequence[float] = value.get("dy0") or (0.0,) * 6
        return "robot_module_msgs/CartesianSpaceDMP", {
            **_ros_dmp(value, rows),
            "header": _header(value.get("frame", "world")),
            "p0": _ros_pose(value["y0"][:3], value["y0"][3:]),
            "goal": _ros_pose(value["goal"][:3], value["goal"][3:]),
            "dp0": {"linear": _axes("xyz", dy0[:3]), "angular": _axes("xyz", dy0[3:])},
        }
    return "std_msgs/String", {"data": msgspec.json.encode(record.value).decode()}


def _geometry(ros_type: str, message: Fields) -> tuple[str, Value] | None:
    frame = str(cast("Fields", message.get("header") or {}).get("frame_id", "")) or "world"
    if ros_type == "geometry_msgs/Pose":
        return "pose", {**_pose(message["position"], message["orientation"]), "frame": "world"}
    if ros_type == "geometry_msgs/PoseStamped":
        return "pose", {**_pose(message["pose"]["position"], message["pose"]["orientation"]), "frame": frame}
    if ros_type == "geometry_msgs/TransformStamped":
        moved = message["transform"]
        return "pose", {**_pose(moved["translation"], moved["rotation"]), "frame": frame}
    return None


def _trajectory(message: Fields) -> Value:
    points = [cast("Fields", point) for point in message["points"]]
    return {
        "times_s": [_seconds(point["time_from_start"]) for point in points],
        "joints": [list(point["positions"]) for point in points],
        "names": list(message.get("joint_names", ())),
    }


def _joint_dmp(message: Fields) -> Value:
    start, goal = list(message["y0"]["position"]), list(message["goal"]["position"])
    speed = list(message["y0"].get("velocity") or ()) or [0.0] * len(start)
    return {**_dmp(message), "y0": start, "dy0": speed, "goal": goal, "w": _rows(message["w"])}


def _cart_dmp(message: Fields) -> Value:
    rows = _rows(message["w"])
    if len(rows) != 6:
        raise ValueError(f"w has {len(rows)} rows, not 6")
    speed = cast("Fields", message.get("dp0") or {})
    dy0 = [*_values("xyz", speed.get("linear")), *_values("xyz", speed.get("angular"))]
    frame = str(cast("Fields", message.get("header") or {}).get("frame_id", "")) or "world"
    return {
        **_dmp(message),
        "y0": [*_values("xyz", message["p0"]["position"]), *_values("xyzw", message["p0"]["orientation"])],
        "goal": [*_values("xyz", message["goal"]["position"]), *_values("xyzw", message["goal"]["orientation"])],
        "dy0": dy0,
        **{f"w{number}": row for number, row in enumerate(rows, 1)},
        "frame": frame,
    }


def _dmp(message: Fields) -> Value:
    a_z, b_z = float(message["a_z"]), float(message.get("b_z") or 0.0)
    if b_z and not math.isclose(b_z, a_z / 4.0, rel_tol=_GAIN_TOLERANCE):
        raise ValueError(f"b_z is {b_z:g}, but flexcell requires a_z / 4 = {a_z / 4.0:g}")
    return {
        "N": int(message["N"] if "N" in message else message["n"]),
        "a_z": a_z,
        "a_x": float(message["a_x"]),
        "tau": float(message["tau"]),
        "id": int(message.get("id", 0)),
        "c": list(message["c"]),
        "sigma": list(message["sigma"]),
    }


def _ros_dmp(value: Fields, rows: Sequence[Sequence[float]]) -> dict[str, Any]:
    return {
        "header": _header(""),
        "N": value["N"],
        "a_z": value["a_z"],
        "b_z": value["a_z"] / 4.0,
        "a_x": value["a_x"],
        "d_t": 0.0,
        "id": value.get("id", 0),
        "tau": value["tau"],
        "c": list(value["c"]),
        "sigma": list(value["sigma"]),
        "w": [{"data": list(row)} for row in rows],
    }


def _rows(weights: Sequence[Any]) -> list[list[float]]:
    """Return rows of weights; the message type of a row has one field, whose name differs between packages."""
    rows: list[list[float]] = []
    for row in weights:
        inner = next(iter(cast("Fields", row).values())) if isinstance(row, Mapping) else row
        rows.append([float(weight) for weight in inner])
    return rows


def _pose(position: Fields, orientation: Fields) -> Value:
    return {"xyz": _values("xyz", position), "xyzw": _values("xyzw", orientation)}


def _values(axes: str, fields: Fields | None) -> list[float]:
    return [float(fields[axis]) for axis in axes] if fields else [0.0] * len(axes)


def _seconds(duration: Fields) -> float:
    whole = duration["secs"] if "secs" in duration else duration["sec"]
    part = duration["nsecs"] if "nsecs" in duration else duration["nanosec"]
    return float(whole) + float(part) * 1e-9


def _header(frame: str) -> dict[str, Any]:
    return {"seq": 0, "stamp": {"secs": 0, "nsecs": 0}, "frame_id": frame}


def _joint_state(position: Sequence[float], names: Sequence[str], velocity: Sequence[float] = ()) -> dict[str, Any]:
    return {
        "header": _header(""),
        "name": list(names),
        "position": list(position),
        "velocity": list(velocity),
        "effort": [],
    }


def _ros_pose(xyz: Sequence[float], xyzw: Sequence[float]) -> dict[str, Any]:
    return {"position": _axes("xyz", xyz), "orientation": _axes("xyzw", xyzw)}


def _axes(axes: str, values: Sequence[float]) -> dict[str, float]:
    return {axis: float(value) for axis, value in zip(axes, values, strict=True)}
