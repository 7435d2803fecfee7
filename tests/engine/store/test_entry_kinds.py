"""The typed kinds accept what fits and name the field that does not."""

from __future__ import annotations

import base64
import math
from pathlib import Path
from typing import Any

import msgspec
import pydantic
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import StoreError
from engine.messages import Pose
from engine.messages.detection_template import MAX_IMAGE_BYTES
from engine.messages.sensing import CameraIntrinsics
from engine.skills.entries import EntryRecord
from engine.store import (
    STANDARD_KINDS,
    DetectionTemplate,
    EntryKind,
    JointDmp,
    Joints,
    SqliteStore,
    TemplateImage,
    decode_entry,
    verified_value,
)

FINITE = st.floats(-1e6, 1e6)
POSITIVE = st.floats(1e-6, 1e6)


@st.composite
def dmps(draw: st.DrawFn) -> JointDmp:
    """Draw a DMP whose lengths agree."""
    joints, kernels = draw(st.integers(1, 7)), draw(st.integers(1, 8))

    def row(length: int, of: st.SearchStrategy[float] = FINITE) -> tuple[float, ...]:
        return tuple(draw(st.lists(of, min_size=length, max_size=length)))

    return JointDmp(
        N=kernels,
        a_z=draw(POSITIVE),
        a_x=draw(POSITIVE),
        tau=draw(POSITIVE),
        goal=row(joints),
        y0=row(joints),
        dy0=row(joints),
        c=row(kernels),
        sigma=row(kernels, POSITIVE),
        w=tuple(row(kernels) for _ in range(joints)),
    )


@given(dmps())
def test_a_dmp_survives_being_stored(dmp: JointDmp) -> None:
    """Its fields as JSON read back as the same DMP."""
    fields = msgspec.json.decode(msgspec.json.encode(dmp))
    assert verified_value(STANDARD_KINDS, "dmp", fields, where="dmp x") == dmp


@given(dmps(), st.sampled_from(["y0", "dy0", "c", "sigma", "w"]))
def test_a_dmp_with_one_list_too_long_is_refused_by_name(dmp: JointDmp, name: str) -> None:
    """Every length is checked against the joints and N."""
    fields: dict[str, Any] = msgspec.to_builtins(dmp)
    fields[name] = [*fields[name], fields[name][0]]
    with pytest.raises(StoreError, match=rf"dmp x: invalid dmp entry: {name} has \d+ values, not \d+"):
        verified_value(STANDARD_KINDS, "dmp", fields, where="dmp x")


def test_a_short_row_of_weights_is_named_by_its_joint() -> None:
    """The second joint lacks a weight."""
    fields = {
        "N": 2, "a_z": 48, "a_x": 2, "tau": 1.5, "goal": [1, 1], "y0": [0, 0], "dy0": [0, 0],
        "c": [1, 0.5], "sigma": [0.1, 0.1], "w": [[1, 2], [3]],
    }  # fmt: skip
    with pytest.raises(StoreError, match=r"w\[1\] has 1 values, not 2 \(2 joints, N = 2\)"):
        verified_value(STANDARD_KINDS, "dmp", fields, where="dmp x")


@given(st.lists(FINITE, min_size=4, max_size=4).filter(lambda q: math.hypot(*q) > 1e-3))
def test_a_pose_is_accepted_exactly_when_its_quaternion_has_unit_length(quaternion: list[float]) -> None:
    """Normalised it is taken; three times as long it is not."""
    length = math.hypot(*quaternion)
    unit = [part / length for part in quaternion]
    taken = verified_value(STANDARD_KINDS, "pose", {"xyz": [0, 0, 0], "xyzw": unit}, where="pose x")
    assert isinstance(taken, Pose)
    with pytest.raises(StoreError, match="the quaternion of the pose has length 3 instead of 1"):
        verified_value(STANDARD_KINDS, "pose", {"xyz": [0, 0, 0], "xyzw": [3 * p for p in unit]}, where="pose x")


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"joints": []}, "joints"),
        ({"joints": [0.1, "a"]}, r"`joints\[1\]`: expected number, got text"),
        ({"joints": [0.1], "names": ["a", "b"]}, "1 joints but 2 names"),
        ({"joint": [0.1]}, r"the fields are joints, names"),
        ([1, 2], "expected mapping"),
    ],
)
def test_bad_joints_are_refused_with_the_reason(fields: object, message: str) -> None:
    """The message names the field, or the fields there are."""
    with pytest.raises(StoreError, match=message):
        verified_value(STANDARD_KINDS, "joints", fields, where="joints x")


def test_a_registered_kind_is_checked_like_the_standard_ones() -> None:
    """Any Struct can be a kind of its own."""

    class Torque(msgspec.Struct, frozen=True):
        torque_nm: float

    kinds = {**STANDARD_KINDS, "torque": EntryKind(Torque)}
    assert verified_value(kinds, "torque", {"torque_nm": 2}, where="torque x") == Torque(2.0)
    with pytest.raises(StoreError, match="invalid torque entry"):
        verified_value(kinds, "torque", {"torque_nm": "much"}, where="torque x")


def test_a_pydantic_model_can_be_a_kind() -> None:
    """Its own checks hold, and what it fills in is stored."""

    class Tray(pydantic.BaseModel):
        rows: int = pydantic.Field(gt=0)
        columns: int = 6

    kinds = {**STANDARD_KINDS, "tray": EntryKind(Tray)}
    assert verified_value(kinds, "tray", {"rows": 2}, where="tray x") == {"rows": 2, "columns": 6}
    assert verified_value(kinds, "tray", Tray(rows=3), where="tray x") == {"rows": 3, "columns": 6}
    assert verified_value(STANDARD_KINDS, "record", Tray(rows=3), where="record x") == {"rows": 3, "columns": 6}
    with pytest.raises(StoreError, match=r"tray x: invalid tray entry: rows: .*greater than 0.*rows, columns"):
        verified_value(kinds, "tray", {"rows": 0}, where="tray x")
    record = EntryRecord(kind="tray", name="x", value={"rows": 2}, revision=1)
    assert decode_entry(record, Tray) == Tray(rows=2)
    with pytest.raises(StoreError, match="tray x: this entry is not a Tray: rows: Field required"):
        decode_entry(EntryRecord(kind="tray", name="x", value={}, revision=1), Tray)


def _png(width_px: int, height_px: int) -> bytes:
    return b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR" + width_px.to_bytes(4) + height_px.to_bytes(4) + b"\x08\x02"


TEMPLATE = DetectionTemplate(
    detector="blobs",
    label="gear",
    image=TemplateImage(format="png", data=_png(32, 24), width_px=32, height_px=24, corner_px=(100, 50)),
    pose=Pose(xyz=(0.1, 0.2, 0.3)),
    camera="overview",
    camera_pose=Pose(xyz=(0.0, 0.0, 1.0), xyzw=(1.0, 0.0, 0.0, 0.0)),
    intrinsics=CameraIntrinsics(width_px=640, height_px=480, fx_px=500.0, fy_px=500.0, cx_px=319.5, cy_px=239.5),
    settings={"threshold": 0.4, "rotated": True},
)


async def test_a_detection_template_is_stored_with_its_image(tmp_path: Path) -> None:
    """Crop, poses, camera and detector come back as they were."""
    async with SqliteStore.open(tmp_path / "s.db", inline=True) as store:
        await store.put("detection", "gear", TEMPLATE, tags=["vision"])
        assert decode_entry(await store.get("detection", "gear"), DetectionTemplate) == TEMPLATE


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"image": None, "pose": None}, "give `image`, `pose` or both"),
        ({"detector": ""}, "detector"),
        (
            {"image": {"format": "png", "data": "AAAAAAAAAAAA", "width_px": 1, "height_px": 1}},
            "data is not in png format",
        ),
        ({"settings": {"a": [1]}}, "settings"),
        ({"camera_pose": {"xyz": [0, 0, 0], "xyzw": [2, 0, 0, 0]}}, "the quaternion of camera_pose has length 2"),
    ],
)
def test_a_detection_template_that_is_none_is_refused_with_the_reason(change: dict[str, object], says: str) -> None:
    """Nothing senseless is kept for a detector to stumble over."""
    fields = {**msgspec.to_builtins(TEMPLATE), **change}
    with pytest.raises(StoreError, match=says):
        verified_value(STANDARD_KINDS, "detection", fields, where="detection x")


def test_the_image_of_a_detection_template_is_what_it_says_and_no_larger_than_four_megabytes() -> None:
    """Its size is bounded before any database sees it."""
    fields = msgspec.to_builtins(TEMPLATE)
    wrong = {**fields, "image": {**fields["image"], "width_px": 33}}
    with pytest.raises(StoreError, match="data is an image of 32 x 24, not 33 x 24"):
        verified_value(STANDARD_KINDS, "detection", wrong, where="detection x")
    large = base64.b64encode(_png(32, 24) + bytes(MAX_IMAGE_BYTES)).decode()
    with pytest.raises(StoreError, match="length <= 4194304"):
        verified_value(
            STANDARD_KINDS, "detection", {**fields, "image": {**fields["image"], "data": large}}, where="detection x"
        )


def test_an_entry_reads_as_its_type_or_says_why_not() -> None:
    """States get typed values out of records."""
    record = EntryRecord(kind="joints", name="home", value={"joints": [0.5, 1]}, revision=3)
    assert decode_entry(record, Joints) == Joints(joints=(0.5, 1.0))
    with pytest.raises(StoreError, match="joints home: this entry is not a Pose"):
        decode_entry(record, Pose)
