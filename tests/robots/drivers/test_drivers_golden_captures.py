"""The bytes on the wire of each protocol are those of the documents' tables, written here by hand.

`>` is sent to the device, `<` comes from it. What arrived in pieces is joined.
"""

from __future__ import annotations

from itertools import groupby
from pathlib import Path

import pytest

from robots.io.wire.read_capture import read_capture
from tests.robots.drivers.write_captures import SESSIONS

FOLDER = Path(__file__).parent / "captures"


def h(text: str) -> bytes:
    """Return bytes in hexadecimal."""
    return bytes.fromhex(text)


def zeros(count: int) -> str:
    """Return so many bytes of 0 in hexadecimal."""
    return "00" * count


# Unit 9, function 3, address 0x07D0, 3 registers, CRC; then 6 bytes of data.
_RTU = [
    (">", h("09 03 07D0 0003 040E")),
    # gSTA 0 reset, gOBJ 0; gFLT 0, gPR 0; gPO 0x73, gCU 0.
    ("<", h("09 03 06 0000 0000 7300 6385")),
    # Unit 9, function 16, address 0x03E8, 3 registers, 6 bytes: rACT 1, nothing else.
    (">", h("09 10 03E8 0003 06 0100 0000 0000 72E1")),
    ("<", h("09 10 03E8 0003 0130")),
    # rACT and rGTO; rPR 255; rSP 255, rFR 255.
    (">", h("09 10 03E8 0003 06 0900 00FF FFFF 4229")),
    ("<", h("09 10 03E8 0003 0130")),
]
_REPLY_OF_MOTION_SERVER = h("0C000000 0B000000 03000000 01000000")
"""LENGTH 12, type 11, SERVICE_REPLY, SUCCESS."""


def point(sequence: str, first_axis: str, duration: str) -> bytes:
    """Return a JOINT_TRAJ_PT: LENGTH 64, type 11, SERVICE_REQUEST, no reply code, and its data in hexadecimal.

    Sequence; ten joints, of which the fifth is 0.5 rad in all points but a stop; velocity 0; duration.
    """
    fifth = zeros(4) if sequence == "FCFFFFFF" else "0000003F"
    joints = first_axis + zeros(12) + fifth + zeros(20)
    return h("40000000 0B000000 02000000 00000000" + sequence + joints + zeros(4) + duration)


_DEGREES = {
    "0": "0000000000000000", "0.25": "000000000000D03F", "0.5": "000000000000E03F", "-0.5": "000000000000E0BF",
    "30": "0000000000003E40",
}  # fmt: skip


def joints(*degrees: str) -> bytes:
    """Return the message EgmJoints of egm.proto within its parent: length 54, field 1, and 6 doubles, field 1 each."""
    return h("38 0A 36" + "".join("09" + _DEGREES[each] for each in degrees))


_HELD = ("0", "0.5", "-0.5", "0", "30", "0")


def asked(first: str, *, session: bool = True, body: str = "") -> tuple[str, bytes]:
    """Return an HTTP request as it is captured; of a session it has a cookie, whose value and digest are left out."""
    lines = [f"{first} HTTP/1.1", "Host: 192.0.2.20", "Accept: */*", "Accept-Encoding: gzip, deflate, zstd"]
    lines += ["Connection: keep-alive", "User-Agent: python-httpx/0.28.1"]
    lines += ["Cookie: (not captured)"] if session else []
    lines += [f"Content-Length: {len(body)}", "Content-Type: application/x-www-form-urlencoded"] if body else []
    lines += ["Authorization: (not captured)"] if session else []
    return ">", ("\r\n".join([*lines, "", ""]) + body).encode()


def answered(states: str) -> tuple[str, bytes]:
    """Return the HTTP answer with the states of a resource, in the JSON of Robot Web Services 1.0."""
    body = f'{{"_links":{{}},"_embedded":{{"_state":[{states}]}}}}'
    return "<", http("200 OK", len(body), "Set-Cookie: (not captured)") + body.encode()


def http(status: str, length: int, *more: str) -> bytes:
    """Return the head of an HTTP answer."""
    lines = [f"HTTP/1.1 {status}", "Content-Type: application/json", f"Content-Length: {length}", *more, "", ""]
    return "\r\n".join(lines).encode()


_EVENT = (
    '{"_type":"elog-message-li","_title":"/rw/elog/0/%s","msgtype":"1","code":"%s","src-name":"MC0",'
    '"tstamp":"2026-01-01 T  12:00:00","argc":"0","title":"%s","desc":"%s","conseqs":"","causes":"","actions":""}'
)
_CHALLENGE = f'Digest realm="validusers@robapi.abb", qop="auth", nonce="{"0" * 32}", algorithm=MD5'
_FIRST = asked("GET /rw/rapid/execution?json=1")[1].replace(b"Cookie: (not captured)\r\n", b"")

GOLDEN: dict[str, list[tuple[str, bytes]]] = {
    "modbus_rtu": _RTU,
    "rtu_over_tcp": _RTU,
    # Transaction, protocol 0, length; then unit, function and data as above, at address 0, and no CRC.
    "modbus_tcp": [
        (">", h("0001 0000 0006 09 04 0000 0003")),
        ("<", h("0001 0000 0009 09 04 06 0000 0000 7300")),
        (">", h("0002 0000 000D 09 10 0000 0003 06 0100 0000 0000")),
        ("<", h("0002 0000 0006 09 10 0000 0003")),
        (">", h("0003 0000 000D 09 10 0000 0003 06 0900 00FF FFFF")),
        ("<", h("0003 0000 0006 09 10 0000 0003")),
    ],
    # The first request has no digest yet, and the second no cookie.
    "rws": [
        asked("GET /rw/rapid/execution?json=1", session=False),
        ("<", http("401 Unauthorized", 0, f"WWW-Authenticate: {_CHALLENGE}")),
        (">", _FIRST),
        answered('{"_type":"rap-execution","ctrlexecstate":"running","cycle":"forever"}'),
        asked("GET /rw/panel/ctrlstate?json=1"),
        answered('{"_type":"pnl-ctrlstate","ctrlstate":"motoron"}'),
        asked("GET /rw/panel/opmode?json=1"),
        answered('{"_type":"pnl-opmode","opmode":"AUTO"}'),
        asked("GET /ctrl/identity?json=1"),
        answered(
            '{"_type":"ctrl-identity-info","ctrl-name":"IRC5_EMULATED","ctrl-id":"4600-501234",'
            '"ctrl-type":"Virtual Controller"}'
        ),
        asked("GET /rw/system?json=1"),
        answered('{"_type":"sys-system","name":"emulated","rwversion":"6.15.0000"}'),
        asked("GET /rw/elog/0?lang=en&json=1"),
        answered(
            _EVENT % (2, 10011, "State motoron", "State motoron")
            + ","
            + _EVENT % (1, 10010, "Motors OFF state", "Motors OFF state")
        ),
        asked("GET /rw/panel/speedratio?json=1"),
        answered('{"_type":"pnl-speedratio","speedratio":"100"}'),
        asked("POST /rw/panel/ctrlstate?action=setctrlstate&json=1", body="ctrl-state=motoron"),
        ("<", http("204 No Content", 0)),
        asked("GET /logout"),
        ("<", http("200 OK", 0, "Set-Cookie: (not captured)")),
    ],
    # EgmRobot: header of 7 bytes with number 7, time 1000 and DATA 2; feedBack, planned; motors ON 1, MCI RUNNING 3,
    # RAPID RUNNING 2. EgmSensor: header with number 1, time 2000 and CORRECTION 3; planned. The first axis to 0.25.
    "egm": [
        (
            "<",
            h("0A 07 08 07 10 E807 18 02 12") + joints(*_HELD) + h("1A") + joints(*_HELD)
            + h("22 02 08 01 2A 02 08 03 42 02 08 02"),
        ),
        (">", h("0A 07 08 01 10 D00F 18 03 12") + joints("0.25", *_HELD[1:])),
    ],
    # One variable a line; `ack` has no line end.
    "urcap": [
        (">", b"GET ACT\n"), ("<", b"ACT 0\n"), (">", b"GET GTO\n"), ("<", b"GTO 0\n"),
        (">", b"GET STA\n"), ("<", b"STA 0\n"), (">", b"GET OBJ\n"), ("<", b"OBJ 0\n"),
        (">", b"GET FLT\n"), ("<", b"FLT 0\n"), (">", b"GET PRE\n"), ("<", b"PRE 0\n"),
        (">", b"GET POS\n"), ("<", b"POS 115\n"), (">", b"GET COU\n"), ("<", b"COU 0\n"),
        (">", b"SET ACT 1 GTO 0 ATR 0 SPE 0 FOR 0 POS 0\n"), ("<", b"ack"),
        (">", b"SET ACT 1 GTO 1 ATR 0 SPE 255 FOR 255 POS 255\n"), ("<", b"ack"),
    ],
    # `::`, address 1, bytes behind this one, command, data, exclusive or of command and data.
    "softhand": [
        # 128 ACTIVATE, 3 on: has no reply. Then 131 GET_INPUTS: what the hand follows before the command.
        (">", h("3A3A 01 03 80 03 83") + h("3A3A 01 02 83 83")),
        ("<", h("3A3A 01 06 83 0000 0000 83")),
        # 130 SET_INPUTS, two words: has no reply. Then 129 GET_ACTIVATE: 3, on.
        (">", h("3A3A 01 06 82 0000 0000 82") + h("3A3A 01 02 81 81")),
        ("<", h("3A3A 01 03 81 03 82")),
        (">", h("3A3A 01 02 83 83")),
        ("<", h("3A3A 01 06 83 0000 0000 83")),
        # 134 GET_CURRENTS_AND_MEASUREMENTS: 60 mA and 0, then three positions.
        (">", h("3A3A 01 02 86 86")),
        ("<", h("3A3A 01 0C 86 003C 0000 0000 0000 0000 BA")),
    ],
    # Angles in degrees, and the last request to the claw. A set point of one degree more, then STOP.
    "servo_lines": [
        ("<", b"READY flexcell_servo_arm 1\n"),
        (">", b"?\n"), ("<", b"HALT boot 0.0 160.0 place\n"),
        (">", b"GO\n"), ("<", b"OK 0.0 160.0 place\n"),
        (">", b"?\n"), ("<", b"OK 0.0 160.0 place\n"),
        (">", b"1.0 161.0\nSTOP\n"),
    ],
    "simple_message_state": [
        (
            "<",
            # LENGTH 56, type 10 JOINT_POSITION, TOPIC, no reply code, sequence 0, ten joints: the fifth is 0.5 rad.
            h("38000000 0A000000 01000000 00000000 00000000" + zeros(16) + "0000003F" + zeros(20))
            # LENGTH 40, type 13 STATUS, TOPIC; drives 1, e-stop 0, error code 0, in error 0, in motion 0, mode 2 auto,
            # motion possible 1.
            + h("28000000 0D000000 01000000 00000000 01000000 00000000 00000000 00000000 00000000 02000000 01000000"),
        ),
    ],
    "simple_message_motion": [
        # Sequence -4 stops; -1 is the first point, 1 the next, -3 the last, which starts. 0.125 and 0.25 rad.
        (">", point("FCFFFFFF", "00000000", "00000000")), ("<", _REPLY_OF_MOTION_SERVER),
        (">", point("FFFFFFFF", "00000000", "0000003F")), ("<", _REPLY_OF_MOTION_SERVER),
        (">", point("01000000", "0000003E", "0000803F")), ("<", _REPLY_OF_MOTION_SERVER),
        (">", point("FDFFFFFF", "0000803E", "0000803F")), ("<", _REPLY_OF_MOTION_SERVER),
    ],
    "gripper_text": [(">", b"gripperON"), ("<", b"done")],
    "ur_dashboard": [
        ("<", b"Connected: Universal Robots Dashboard Server\n"),
        (">", b"safetystatus\n"),
        ("<", b"Safetystatus: NORMAL\n"),
    ],
    "ur_secondary": [(">", b"sec flexcell_output():\n  set_digital_out(3, True)\nend\n")],
    # Big-endian; size with header, type. Sent by the client library of Universal Robots' users, `ur-rtde`.
    "rtde": [
        # V: protocol version 2, accepted.
        (">", h("0005 56 0002")), ("<", h("0004 56 01")),
        # v: controller version 3.15.8, build 106339.
        (">", h("0003 76")), ("<", h("0013 76 00000003 0000000F 00000008 00019F63")),
        # O: 125.0 Hz, names with a comma behind the last one; recipe 1, the types.
        (">", h("0029 4F 405F400000000000") + b"timestamp,actual_q,robot_mode,"),
        ("<", h("0019 4F 01") + b"DOUBLE,VECTOR6D,INT32"),
        # S: accepted. U, recipe 1: time stamp, six angles of ±90° and 0, robot mode 7 running.
        (">", h("0003 53")),
        (
            "<",
            h("0004 53 01")
            + h("0040 55 01 3FCBA5E353F7CEDE 0000000000000000 BFF921FB54442D18 3FF921FB54442D18")
            + h("BFF921FB54442D18 BFF921FB54442D18 0000000000000000 00000007"),
        ),
    ],
    # Doubles and bytes, little-endian, one datagram each; the ports are compared below.
    "reconcell": [
        # 20000: six joints of 0, of direct control, whose mode is never selected.
        (">", h(zeros(48))),
        # 26000: six joints of ±0.5 rad, speed 0.25.
        (">", h("000000000000E03F 000000000000E0BF" * 3 + "000000000000D03F")),
        # 10000: mode byte 5, joint trapezoidal; 0, our extension, ends the motion.
        (">", h("05")),
        # 15001: received mode 12, sent mode 12, idle, error, running, received, finished.
        ("<", h("0C 0C 00 00 01 01 00")),
        (">", h("00")),
    ],
}  # fmt: skip
PORTS = [20000, 26000, 10000, 15001, 10000]


def test_every_protocol_has_a_capture() -> None:
    assert set(GOLDEN) == set(SESSIONS) == {file.stem for file in FOLDER.glob("*.pcapng")}


@pytest.mark.parametrize("protocol", sorted(GOLDEN))
def test_the_capture_has_the_bytes_of_the_documents(protocol: str) -> None:
    captured = read_capture(FOLDER / f"{protocol}.pcapng")
    signs = {"sent": ">", "received": "<"}
    data = [(signs[each.kind], each.data) for each in captured.events if each.kind in signs]
    if captured.transport != "udp":
        data = [(sign, b"".join(part for _, part in parts)) for sign, parts in groupby(data, key=lambda each: each[0])]
    if protocol == "rtde":
        # More data packets of the same kind follow.
        data[-1] = (data[-1][0], data[-1][1][: len(GOLDEN[protocol][-1][1])])
    assert (captured.protocol, data) == (protocol, GOLDEN[protocol])


def test_datagrams_have_the_ports_of_the_appendix() -> None:
    events = read_capture(FOLDER / "reconcell.pcapng").events
    ends = [each.endpoints for each in events if each.endpoints is not None]
    sent = [each.kind == "sent" for each in events]
    assert [end.remote[1] if is_sent else end.local[1] for end, is_sent in zip(ends, sent, strict=True)] == PORTS
