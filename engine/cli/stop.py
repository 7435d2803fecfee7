"""`flexcell stop`: STOP of the cell of a running server, on the path that needs no answer of the server itself.

Imports next to nothing, so that the command is on its way within a few hundredths of a second.
"""

from __future__ import annotations

import http.client
import json
import sys
import time
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from engine.state_names import SERVER_FILE

REASON = "flexcell stop"
_ANSWER_S = 2.0
_REST_S = 10.0
_LOOK_S = 0.02


def stop_cell(state: Path, reason: str) -> int:
    """Stop the cell of the server that keeps its state in `state`; print how far it is and return the exit code.

    0: everything is at rest. 2: no server runs there. 3: nobody answers, or something does not come to rest.
    """
    file = state / SERVER_FILE
    try:
        record: dict[str, Any] = json.loads(file.read_bytes())
        url, token = str(record["stop_url"]), str(record["stop_token"])
    except (OSError, ValueError, KeyError) as error:
        sys.stderr.write(f"flexcell: {file}: no server runs here ({error}); give --state, or use the emergency stop\n")
        return 2
    try:
        status = _posted(url, token, reason)
    except (OSError, http.client.HTTPException, ValueError) as error:
        return _stopped_by_server(record, reason, error)
    sys.stdout.write(f"STOP acknowledged after {status['after_s'] * 1000:.0f} ms{_engine(status)}\n")
    sys.stdout.flush()
    return _wait_for_rest(url, token, status)


def _wait_for_rest(url: str, token: str, status: dict[str, Any]) -> int:
    deadline_s = time.monotonic() + _REST_S
    while not status["at_rest"] and time.monotonic() < deadline_s:
        time.sleep(_LOOK_S)
        try:
            status = _posted(f"{url}/status", token, "")
        except (OSError, http.client.HTTPException, ValueError):
            break
    if not status["at_rest"]:
        moving = ", ".join(each["name"] for each in status["devices"] if not each["at_rest"])
        sys.stderr.write(f"flexcell: {moving}: does not confirm that it rests; use the emergency stop\n")
        return 3
    sys.stdout.write(f"At rest after {status['after_s']:.2f} s.\n")
    return 0


def _stopped_by_server(record: dict[str, Any], reason: str, error: Exception) -> int:
    """Ask the server itself where the relay does not answer."""
    sys.stderr.write(f"flexcell: the stop relay does not answer ({error}); asking the server\n")
    try:
        _posted(f"{record['url']}api/v1/cell/stop", str(record["token"]), reason, timeout_s=_REST_S)
    except (OSError, http.client.HTTPException, ValueError, KeyError) as failure:
        sys.stderr.write(f"flexcell: nobody takes STOP ({failure}); use the emergency stop\n")
        return 3
    sys.stdout.write("Stopped: the server has confirmed that every robot is at rest.\n")
    return 0


def _posted(url: str, token: str, reason: str, *, timeout_s: float = _ANSWER_S) -> dict[str, Any]:
    """Post a stop and return the answer; raises OSError, HTTPException or ValueError."""
    parts = urlsplit(url)
    connection = http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=timeout_s)
    try:
        headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/json"}
        connection.request("POST", parts.path, json.dumps({"reason": reason}), headers)
        response = connection.getresponse()
        body = response.read()
        if response.status >= 300:
            raise ValueError(f"it answered {response.status}: {body[:200].decode('utf-8', 'replace')}")
        return json.loads(body) if body else {}
    finally:
        connection.close()


def _engine(status: dict[str, Any]) -> str:
    if status["engine"] == "informed":
        return "."
    return ", and the engine does not answer." if status["engine"] == "silent" else ", and the engine has ended."
