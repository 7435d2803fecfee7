"""Lines of the board of a servo arm: written out, and any bytes."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.drivers.servo_arm.servo_lines import BoardReply, decode_reply, encode_set_point
from tests.tiers import examples

MANY = settings(max_examples=examples(200, nightly=25_000))
ANGLES = st.lists(st.floats(-400.0, 400.0), min_size=1, max_size=8)


@pytest.mark.parametrize(
    ("angles", "decimals", "line"),
    [
        ((45.0, 120.0), 1, b"45.0 120.0\n"),
        ((44.96, 119.94), 1, b"45.0 119.9\n"),
        ((-0.01, 7.5), 1, b"0.0 7.5\n"),
        ((44.96, 119.4), 0, b"45 119\n"),
    ],
)
def test_a_set_point_is_rounded_to_what_the_wire_says(angles: tuple[float, ...], decimals: int, line: bytes) -> None:
    assert encode_set_point(angles, decimals=decimals) == line


@pytest.mark.parametrize(
    ("line", "reply"),
    [
        (b"READY flexcell_servo_arm 1", BoardReply(started=True)),
        (b"OK 45.0 120.0", BoardReply(angles_deg=(45.0, 120.0))),
        (b"OK 45.0 120.0 pick", BoardReply(angles_deg=(45.0, 120.0), claw_closes=True)),
        (b"OK 45.0 120.0 place", BoardReply(angles_deg=(45.0, 120.0), claw_closes=False)),
        (b"HALT stop 45.0 120.0", BoardReply(angles_deg=(45.0, 120.0), halt="the board was stopped")),
        (b"HALT other 1 2", BoardReply(angles_deg=(1.0, 2.0), halt="other")),
        (b"ERR out of range", BoardReply(error="out of range")),
        (b"ERR", BoardReply(error="no reason")),
    ],
)
def test_a_line_of_the_board_has_this_meaning(line: bytes, reply: BoardReply) -> None:
    assert decode_reply(line, servos=2) == reply


@pytest.mark.parametrize(
    "line",
    [b"", b"OK", b"OK 1", b"OK 1 2 3", b"OK 1 nan", b"HALT", b"HALT stop 1", b"ok 1 2", b"OK pick", b"OK 1 2 open"],
)
def test_a_line_of_another_form_means_nothing(line: bytes) -> None:
    assert decode_reply(line, servos=2) is None


@MANY
@given(ANGLES)
def test_a_set_point_survives_its_line_but_for_its_rounding(angles: list[float]) -> None:
    line = encode_set_point(angles, decimals=1)
    assert line.endswith(b"\n")
    reply = decode_reply(b"OK " + line.strip(), servos=len(angles))
    assert reply is not None
    assert reply.angles_deg == pytest.approx(angles, abs=0.0501)


@MANY
@given(st.binary(max_size=100))
def test_any_bytes_mean_something_or_nothing(line: bytes) -> None:
    reply = decode_reply(line, servos=2)
    assert reply is None or len(reply.angles_deg) in (0, 2)


@pytest.mark.parametrize("angle", [float("nan"), float("inf")])
def test_no_angle_that_is_none_is_sent(angle: float) -> None:
    with pytest.raises(ValueError, match="are no angles"):
        encode_set_point((0.0, angle), decimals=1)
