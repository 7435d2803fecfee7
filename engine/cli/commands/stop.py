"""`flexcell stop`: STOP of the cell of a running server, through a relay that works while the server is blocked.

`--release` asks the server itself to let runs start again.

Imports as little as possible, so that the request leaves within a few hundredths of a second.
"""

from __future__ import annotations

import json
import socket
import sys
import time
from pathlib import Path
from typing import Any

from engine.host.state_folder_names import SERVER_FILE

REASON = "flexcell stop"
_ANSWER_S = 2.0
_REST_S = 10.0
_POLL_S = 0.02
_READ_BYTES = 65536


def stop_cell(state: Path, reason: str) -> int:
    """Stop the cell of the server that keeps its state in `state`; print the progress and return the exit code.

    0: all devices are at rest. 2: no server runs there. 3: no answer, or a device does not come to rest.
    """
    record = _server(state, "stop_url", "stop_token", hint="give --state, or use the emergency stop")
    if record is None:
        return 2
    url, token = str(record["stop_url"]), str(record["stop_token"])
    try:
        status = _post(url, token, {"reason": reason})
        acknowledged = f"STOP acknowledged after {status['after_s'] * 1000:.0f} ms{_engine(status)}\n"
    except (OSError, ValueError, TypeError, KeyError) as error:
        return _stopped_by_server(record, reason, error)
    sys.stdout.write(acknowledged)
    sys.stdout.flush()
    return _wait_for_rest(url, token, status)


def release_stop(state: Path) -> int:
    """Release the stop of the server that keeps its state in `state`: runs may start again; return the exit code.

    0: released. 2: no server runs there. 3: it refuses, for example because a device has not confirmed rest.
    """
    record = _server(state, "url", "token", hint="give --state")
    if record is None:
        return 2
    try:
        _post(f"{record['url']}api/v1/cell/stop/release", str(record["token"]), {}, timeout_s=_REST_S)
    except (OSError, ValueError) as error:
        sys.stderr.write(f"flexcell: the stop is not released: {error}\n")
        return 3
    sys.stdout.write("The stop is released: runs may start.\n")
    return 0


def _server(state: Path, *keys: str, hint: str) -> dict[str, Any] | None:
    """Return the record of the server that keeps its state in `state`, with these keys; None if none runs there."""
    file = state / SERVER_FILE
    try:
        record: dict[str, Any] = json.loads(file.read_bytes())
        for key in keys:
            _ = record[key]
    except (OSError, ValueError, KeyError) as error:
        sys.stderr.write(f"flexcell: {file}: no server runs here ({error}); {hint}\n")
        return None
    return record


def _wait_for_rest(url: str, token: str, status: dict[str, Any]) -> int:
    deadline_s = time.monotonic() + _REST_S
    while not status["at_rest"] and time.monotonic() < deadline_s:
        time.sleep(_POLL_S)
        try:
            status = _post(f"{url}/status", token, {})
        except (OSError, ValueError):
            break
    if not status["at_rest"]:
        moving = ", ".join(each["name"] for each in status["devices"] if not each["at_rest"])
        sys.stderr.write(f"flexcell: {moving}: not confirmed at rest; use the emergency stop\n")
        return 3
    sys.stdout.write(f"At rest after {status['after_s']:.2f} s.\n")
    return 0


def _stopped_by_server(record: dict[str, Any], reason: str, error: Exception) -> int:
    """Send STOP to the server itself if the relay does not answer."""
    sys.stderr.write(f"flexcell: the stop relay does not answer ({error}); sending STOP to the server\n")
    try:
        _post(f"{record['url']}api/v1/cell/stop", str(record["token"]), {"reason": reason}, timeout_s=_REST_S)
    except (OSError, ValueError, KeyError) as failure:
        sys.stderr.write(f"flexcell: the server does not accept STOP ({failure}); use the emergency stop\n")
        return 3
    sys.stdout.write("Stopped: the server confirms that every robot is at rest.\n")
    return 0


def _post(url: str, token: str, fields: dict[str, str], *, timeout_s: float = _ANSWER_S) -> dict[str, Any]:
    """Post a request and return the response.

    Writes HTTP/1.0 directly: importing http.client takes half as long as everything else before STOP is sent.

    Raises:
        OSError: no connection, or no response.
        ValueError: the response is not a success.
    """
    authority, _, path = url.removeprefix("http://").partition("/")
    host, _, port = authority.rpartition(":")
    body = json.dumps(fields).encode()
    head = (
        f"POST /{path} HTTP/1.0\r\nHost: {authority}\r\nAuthorization: Bearer {token}\r\n"
        f"Content-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
    )
    with socket.create_connection((host.strip("[]"), int(port)), timeout=timeout_s) as connection:
        connection.sendall(head.encode("latin-1") + body)
        answer = b"".join(iter(lambda: connection.recv(_READ_BYTES), b""))
    status, _, rest = answer.partition(b"\r\n")
    content = rest.partition(b"\r\n\r\n")[2]
    code = status.split()[1:2] if status.startswith(b"HTTP/") else []
    if code not in ([b"200"], [b"204"]):
        raise ValueError(f"unexpected response: {answer[:200].decode('utf-8', 'replace')!r}")
    return json.loads(content) if content else {}


def _engine(status: dict[str, Any]) -> str:
    if status["engine"] == "informed":
        return "."
    return ", and the engine does not answer." if status["engine"] == "silent" else ", and the engine has ended."
