"""Movement primitives as data accept what fits and name the field that does not."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import StoreError
from engine.messages import Pose
from engine.messages.primitives import CartDmp, CartOffsets, ForceReference, JointDmp
from engine.store import STANDARD_KINDS, verified_value

FINITE = st.floats(-1e6, 1e6)
POSITIVE = st.floats(1e-6, 1e6)


@st.composite
def cart_dmps(draw: st.DrawFn) -> CartDmp:
    """Draw a Cartesian DMP whose lengths agree."""
    kernels = draw(st.integers(1, 6))

    def row(length: int, of: st.SearchStrategy[float] = FINITE) -> tuple[float, ...]:
        return tuple(draw(st.lists(of, min_size=length, max_size=length)))

    def pose() -> tuple[float, ...]:
        quaternion = draw(st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: math.hypot(*q) > 0.1))
        return (*row(3), *(part / math.hypot(*quaternion) for part in quaternion))

    return CartDmp(
        N=kernels, a_z=draw(POSITIVE), a_x=draw(POSITIVE), tau=draw(POSITIVE), id=draw(st.integers(0, 99)),
        goal=pose(), y0=pose(), dy0=row(6), c=row(kernels), sigma=row(kernels, POSITIVE),
        w1=row(kernels), w2=row(kernels), w3=row(kernels), w4=row(kernels), w5=row(kernels), w6=row(kernels),
        tasktrans=draw(st.sampled_from([(), TURNED])),
    )  # fmt: skip


TURNED = (0.0, -1.0, 0.0, 0.5, 1.0, 0.0, 0.0, -0.2, 0.0, 0.0, 1.0, 0.1, 0.0, 0.0, 0.0, 1.0)
"""A quarter turn about z, and (0.5, -0.2, 0.1) m."""

PLAIN: dict[str, Any] = {
    "N": 2, "a_z": 48, "a_x": 2, "tau": 1.5, "goal": [1, 0, 0, 0, 0, 0, 1], "y0": [0, 0, 0, 0, 0, 0, 1],
    "c": [1, 0.5], "sigma": [0.1, 0.1], **{f"w{axis}": [1, 2] for axis in range(1, 7)},
}  # fmt: skip


@given(cart_dmps())
def test_a_cartesian_dmp_survives_being_stored(dmp: CartDmp) -> None:
    """Its fields as JSON read back as the same."""
    fields = msgspec.json.decode(msgspec.json.encode(dmp))
    assert verified_value(STANDARD_KINDS, "cart_dmp", fields, where="cart_dmp x") == dmp


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"w4": [1]}, r"w4 has 1 values, not 2 \(N = 2\)"),
        ({"sigma": [0.1]}, r"sigma has 1 values, not 2 \(N = 2\)"),
        ({"goal": [1, 0, 0]}, "goal has 3 values, not 7"),
        ({"dy0": [1, 0, 0]}, "dy0 has 3 values, not 6"),
        ({"goal": [1, 0, 0, 0, 0, 0, 2]}, "the quaternion of goal has length 2 instead of 1"),
        ({"tasktrans": [1, 0, 0]}, "tasktrans has 3 values, not 16"),
        ({"tasktrans": [2 * value for value in TURNED]}, "of tasktrans are not a rotation matrix"),
        ({"tasktrans": [-value for value in TURNED[:12]] + [0, 0, 0, 1]}, "tasktrans is a reflection"),
        ({"tasktrans": [*TURNED[:12], 0, 0, 1, 1]}, "the last row of tasktrans is not 0 0 0 1"),
        ({"tau": 0}, "expected number > 0.0"),
        ({"sigma": [0.1, -0.1]}, "expected number > 0.0"),
        ({"w7": [1, 2]}, "w7"),
    ],
)
def test_a_cartesian_dmp_that_does_not_fit_is_refused_with_the_field(change: dict[str, object], words: str) -> None:
    with pytest.raises(StoreError, match=words):
        verified_value(STANDARD_KINDS, "cart_dmp", {**PLAIN, **change}, where="cart_dmp x")


def test_numbers_that_are_not_finite_are_refused() -> None:
    """They come from YAML and from Python, not from JSON."""
    with pytest.raises(msgspec.ValidationError, match=r"w2\[1\] is nan"):
        msgspec.convert({**PLAIN, "w2": [1.0, math.nan]}, CartDmp)
    with pytest.raises(msgspec.ValidationError, match=r"goal\[0\] is inf"):
        msgspec.convert({**_joint_fields(), "goal": [math.inf, 0.0]}, JointDmp)


def test_a_task_transformation_moves_the_start() -> None:
    """The quarter turn brings x to y; the joint map mixes the joints."""
    dmp = msgspec.convert({**PLAIN, "y0": [1, 0, 0, 0, 0, 0, 1], "tasktrans": TURNED}, CartDmp)
    half = math.sqrt(0.5)
    assert dmp.start.xyz == pytest.approx((0.5, 0.8, 0.1))
    assert dmp.start.xyzw == pytest.approx((0.0, 0.0, half, half))
    assert msgspec.convert(PLAIN, CartDmp).start == Pose(xyz=(0.0, 0.0, 0.0))
    joint = msgspec.convert({**_joint_fields(), "y0": [1.0, 2.0], "tasktrans": [0, 1, -1, 0]}, JointDmp)
    assert joint.start == (2.0, -1.0)
    with pytest.raises(msgspec.ValidationError, match="tasktrans has 3 values, not 4"):
        msgspec.convert({**_joint_fields(), "tasktrans": [0, 1, -1]}, JointDmp)


@given(st.tuples(*[st.floats(-3, 3)] * 3).filter(lambda v: 0.1 < math.hypot(*v) < 3.1))
def test_every_rotation_of_a_task_transformation_turns_the_start(vector: tuple[float, float, float]) -> None:
    """The matrix of an axis and an angle gives the quaternion of that axis and angle."""
    angle = math.hypot(*vector)
    x, y, z = (part / angle for part in vector)
    s, c, v = math.sin(angle), math.cos(angle), 1.0 - math.cos(angle)
    matrix = [
        *(c + x * x * v, x * y * v - z * s, x * z * v + y * s, 0.0),
        *(y * x * v + z * s, c + y * y * v, y * z * v - x * s, 0.0),
        *(z * x * v - y * s, z * y * v + x * s, c + z * z * v, 0.0),
        *(0.0, 0.0, 0.0, 1.0),
    ]
    turned = msgspec.convert({**PLAIN, "tasktrans": matrix}, CartDmp).start.xyzw
    half = math.sin(angle / 2.0)
    wanted = (x * half, y * half, z * half, math.cos(angle / 2.0))
    assert abs(sum(a * b for a, b in zip(turned, wanted, strict=True))) == pytest.approx(1.0, abs=1e-9)


def test_offsets_and_forces_are_checked_by_their_kernels() -> None:
    """Each row has as many weights as there are centres."""
    with pytest.raises(ValueError, match=r"w3o has 1 values, not 2 \(2 kernels in c_o\)"):
        CartOffsets(
            c_o=(1.0, 0.5), sigma_o=(0.1, 0.1),
            w1o=(0.0, 0.0), w2o=(0.0, 0.0), w3o=(0.0,), w4o=(0.0, 0.0), w5o=(0.0, 0.0), w6o=(0.0, 0.0),
        )  # fmt: skip
    force = ForceReference.constant(force_n=(0.0, 0.0, 10.0))
    assert (force.N_f, force.w3f, force.w6f) == (1, (10.0,), (0.0,))
    with pytest.raises(msgspec.ValidationError, match="c_f has 1 values, not 2"):
        msgspec.convert({**msgspec.to_builtins(force), "N_f": 2}, ForceReference)


def _joint_fields() -> dict[str, Any]:
    return {
        "N": 1, "a_z": 48, "a_x": 2, "tau": 1.5, "goal": [1, 1], "y0": [0, 0], "dy0": [0, 0],
        "c": [0.5], "sigma": [1.0], "w": [[0], [0]],
    }  # fmt: skip
