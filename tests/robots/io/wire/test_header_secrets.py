"""What proves who asks does not get into a capture, in whatever pieces its bytes pass; all other bytes do."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.io.wire.header_secrets import HeaderSecrets

REQUEST = (
    b"GET /rw/system HTTP/1.1\r\nHost: a\r\nAuthorization: Digest username=u, response=5ec4e7\r\n"
    b'COOKIE: ABBCX=5ec4e7\r\nContent-Length: 9\r\n\r\n{"co": 1}'
)
WRITTEN = (
    b"GET /rw/system HTTP/1.1\r\nHost: a\r\nAuthorization: (not captured)\r\n"
    b'COOKIE: (not captured)\r\nContent-Length: 9\r\n\r\n{"co": 1}'
)


def passed(*pieces: bytes) -> bytes:
    secrets = HeaderSecrets()
    return b"".join(secrets.passed(piece) for piece in pieces) + secrets.rest()


@pytest.mark.parametrize("size", [1, 2, 3, 7, 50, 1000])
def test_credentials_and_cookies_are_replaced_in_pieces_of_any_size(size: int) -> None:
    pieces = [REQUEST[start : start + size] for start in range(0, len(REQUEST), size)]
    assert passed(*pieces, *pieces) == WRITTEN * 2


@pytest.mark.parametrize(
    ("line", "written"),
    [
        (b"Set-Cookie: a=5ec4e7\r\n", b"Set-Cookie: (not captured)\r\n"),
        (b"Authentication-Info: rspauth=5ec4e7\n", b"Authentication-Info: (not captured)\n"),
        (b"Proxy-Authorization :5ec4e7\r\n", b"Proxy-Authorization : (not captured)\r\n"),
        # A value may go on in the next line.
        (b"Cookie: a=1;\r\n b=5ec4e7\r\nHost: b\r\n", b"Cookie: (not captured)\r\n (not captured)\r\nHost: b\r\n"),
        (b"Cookie: 5ec4e7", b"Cookie: (not captured)"),
        (b"Cook", b"Cook"),
    ],
)
def test_a_line_that_proves_who_asks_keeps_its_name_only(line: bytes, written: bytes) -> None:
    assert passed(line) == written
    assert passed(*(bytes((byte,)) for byte in line)) == written


@given(st.lists(st.binary(max_size=30).filter(lambda piece: b"u" not in piece.lower() and b"k" not in piece.lower())))
def test_other_bytes_pass_unchanged(pieces: list[bytes]) -> None:
    """No such name is without a `u` or a `k`."""
    assert passed(*pieces) == b"".join(pieces)
