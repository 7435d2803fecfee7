"""What the real server needs for an edit of a document of 1,000 states: time and size of answers.

`python -m benchmarks.edits` starts `flexcell serve` in a temporary project, opens a document as the page does, and
sends edits one after the other, each of the text that the last one left. It prints, for each kind of edit, the median
and the 95th percentile of the time until the answer is there with its findings, and of the CPU time of the server for
it, which other work on the machine changes less; and the size of an answer beside that of the whole graph. The first
edit of each kind is not counted. Positions and notes are not checked: the page has them before it asks.
"""

from __future__ import annotations

import argparse
import http.client
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from benchmarks.large_document import large_document
from benchmarks.process_cpu import cpu_now_s
from editor_web.security.authentication import load_access_tokens

_PROGRAM = "from engine.cli.main import main; main()"
_HOST = "127.0.0.1"
_GIVE_UP_S = 60.0
_LAYOUT = ("position", "note")
Plain = dict[str, object]


@dataclass(frozen=True, kw_only=True)
class Subject:
    """A document to edit: `place` is a container of `wait_…` or `s…` states named in `nodes`."""

    name: str
    text: str
    place: str
    nodes: tuple[str, str]


@dataclass(frozen=True)
class Timing:
    """One edit: seconds until its answer and its findings, of CPU of the server, and bytes of its answer."""

    answer_s: float
    cpu_s: float
    size: int


def flat_document(states: int = 1000) -> str:
    """Return one machine of so many states, each with a canvas position."""
    lines = ["flexcell: 1", "name: flat", "outcomes: [finished]", "success: [finished]", "root:", "  machine:"]
    lines += ["    initial: s0", "    states:"]
    for number in range(states):
        follower = f"s{number + 1}" if number < states - 1 else "finished"
        lines += [f"      s{number}:", "        state: flow.Wait  # lets things settle"]
        lines += ["        with: {duration_s: 0.5}", f"        transitions: {{done: {follower}}}"]
    lines += ["view:", *(f"  root/s{number}: [{number * 100}, 40]" for number in range(states))]
    return "\n".join(lines) + "\n"


def subjects(states: int) -> tuple[Subject, ...]:
    """Return both documents: all states in one machine, and in nested containers."""
    return (
        Subject(name="flat", text=flat_document(states), place="root", nodes=("s500", "s501")),
        Subject(
            name="nested",
            text=large_document(states),
            place="root/area_3/step_0",
            nodes=("wait_5", "wait_6"),
        ),
    )


def edits_of(subject: Subject) -> dict[str, Callable[[int], Plain]]:
    """Return each kind of edit, by its number."""
    place, (one, two) = subject.place, subject.nodes
    node = f"{place}/{one}"
    return {
        "position": lambda n: {"edit": "set_positions", "positions": {node: [n, 2 * n]}},
        "note": lambda n: {"edit": "set_field", "path": node, "field": "notes", "value": f"note {n}"},
        "rename": lambda n: {
            "edit": "rename_node",
            "path": f"{place}/{two if n == 0 else f'renamed_{n - 1}'}",
            "name": f"renamed_{n}",
        },
        "add node": lambda n: {
            "edit": "add_node",
            "parent": place,
            "kind": "state",
            "runs": "flow.Wait",
            "parameters": {"duration_s": 1},
            "on_edge": {"from": node, "outcome": "done"},
        },
        "add transition": lambda n: {
            "edit": "set_transition",
            "path": node,
            "outcome": "done",
            "target": one if n % 2 else f"{one[:-1]}{7 + n % 3}",
        },
        "parameter": lambda n: {"edit": "set_parameter", "path": node, "name": "duration_s", "value": n + 1},
    }


class Page:
    """Asks the server as the page does, on one connection."""

    def __init__(self, port: int, token: str, server: int) -> None:
        self._server = server
        self._connection = http.client.HTTPConnection(_HOST, port, timeout=_GIVE_UP_S)
        self._headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/json"}

    def ask(self, method: str, path: str, body: Plain | None = None) -> tuple[Plain, int]:
        """Return the answer and its size in bytes.

        Raises:
            RuntimeError: the server refused.
        """
        sent = json.dumps(body).encode() if body is not None else None
        self._connection.request(method, f"/api/v1/documents/{path}", body=sent, headers=self._headers)
        response = self._connection.getresponse()
        read = response.read()
        if response.status >= 300:
            raise RuntimeError(f"{method} {path}: {response.status} {read[:300].decode()}")
        return cast("Plain", json.loads(read)) if read.startswith(b"{") else {}, len(read)

    def edit(self, document: str, state: Plain, edit: Plain, *, check: bool) -> tuple[Plain, Timing]:
        """Send one edit of the text in `state`; return its answer, and how long it took."""
        body: Plain = {"text": state["text"], "edits": [edit], "check": check, "graph": state["hash"]}
        spent, start = cpu_now_s(self._server), time.perf_counter()
        answer, size = self.ask("POST", f"{document}/edits", body)
        if answer["refused"] is not None:
            raise RuntimeError(f"refused: {answer['refused']}")
        if check and not answer["checked"]:
            self.ask("POST", f"{document}/findings", {"text": answer["text"]})
        return answer, Timing(time.perf_counter() - start, cpu_now_s(self._server) - spent, size)


def measure(page: Page, document: str, subject: Subject, rounds: int) -> tuple[dict[str, list[Timing]], int]:
    """Return the timings by kind of edit, and the size of an answer with the whole graph, in bytes."""
    found: dict[str, list[Timing]] = {}
    opened, whole = page.ask("GET", f"{document}?check=false")
    for name, make in edits_of(subject).items():
        state = opened
        timings: list[Timing] = []
        for number in range(rounds + 1):
            state, timing = page.edit(document, state, make(number), check=name not in _LAYOUT)
            timings.append(timing)
        found[name] = timings[1:]
    return found, whole


def percentile(values: Sequence[float], share: float) -> float:
    """Return the value below which a share of all values lies."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, round(share * (len(ordered) - 1)))]


def _report(subject: Subject, found: dict[str, list[Timing]], whole: int) -> None:
    print(f"{subject.name}: text {len(subject.text) / 1e3:.0f} kB, answer with the whole graph {whole / 1e3:.0f} kB")
    print(f"  {'edit':16}{'answer, ms':>18}{'CPU of the server, ms':>27}{'answer, kB':>12}")
    print(f"  {'':16}{'p50':>9}{'p95':>9}{'least':>9}{'p50':>9}{'p95':>9}")
    for name, timings in found.items():
        answers, cpu = [each.answer_s for each in timings], [each.cpu_s for each in timings]
        values = [percentile(answers, 0.5), percentile(answers, 0.95), *(percentile(cpu, at) for at in (0, 0.5, 0.95))]
        shown = "".join(f"{value * 1e3:9.1f}" for value in values)
        print(f"  {name:16}{shown}{max(each.size for each in timings) / 1e3:12.1f}")


def _wait(server: subprocess.Popen[bytes], port: int, token: str) -> Page:
    deadline = time.monotonic() + _GIVE_UP_S
    while time.monotonic() < deadline and server.poll() is None:
        page = Page(port, token, server.pid)
        try:
            page.ask("GET", "behaviors/flat.yaml?check=false")
        except OSError:
            time.sleep(0.1)
        else:
            return page
    raise RuntimeError("the server did not start")


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a table for each document."""
    parser = argparse.ArgumentParser(description="Measure edits of large documents through the real server.")
    parser.add_argument("--states", type=int, default=1000, help="states of each document")
    parser.add_argument("--rounds", type=int, default=30, help="edits of each kind")
    parser.add_argument("--port", type=int, default=8649)
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder)
        (project / "behaviors").mkdir()
        for subject in subjects(options.states):
            (project / "behaviors" / f"{subject.name}.yaml").write_text(subject.text, encoding="utf-8")
        token = load_access_tokens(project / ".flexcell" / "tokens").operator
        command = [sys.executable, "-c", _PROGRAM, "serve", "--host", _HOST, "--port", str(options.port)]
        paths = os.pathsep.join(filter(None, (str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH"))))
        environment = os.environ | {"PYTHONPATH": paths}
        with subprocess.Popen(
            command, cwd=project, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        ) as server:
            try:
                page = _wait(server, options.port, token)
                for subject in subjects(options.states):
                    _report(subject, *measure(page, f"behaviors/{subject.name}.yaml", subject, options.rounds))
            finally:
                server.send_signal(signal.SIGTERM)
                server.wait(_GIVE_UP_S)


if __name__ == "__main__":
    main()
