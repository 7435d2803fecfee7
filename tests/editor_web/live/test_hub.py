"""The live stream: snapshots, coalesced deltas, reconnecting, and clients that are slow."""

from __future__ import annotations

import asyncio
import socket
from types import SimpleNamespace
from typing import cast

import pytest
from websockets.exceptions import ConnectionClosedError

from editor_web.live.hub import LiveClient, LiveHub
from editor_web.live.live_frames import LiveDelta, LiveSnapshot, SweepsChanged
from editor_web.sockets import page_socket as sockets
from engine.event import MessageLogged, NodeEntered, NodeExited, RunEnded, RunStarted
from engine.runtime.control import Control, ControlView
from engine.runtime.history.live_run import LOG_LINES
from engine.sweep_library import SweepLive
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_behaviors import TRANSFER
from tests.editor_web.limits import GUARD_S
from tests.editor_web.served import Served

STARTED: dict[str, object] = {"behavior": "b", "document": "d", "parameters": {}, "seed": 1, "clock": "real"}


def open_hub(backend: FakeBackend, wall_s: list[float] | None = None) -> LiveHub:
    """A hub that follows the backend."""
    hub = LiveHub(backend, wall_s=lambda: wall_s[0] if wall_s else 0.0)
    hub.open()
    return hub


def watching(hub: LiveHub, run: str) -> LiveClient:
    """A client that has its snapshot."""
    client = hub.join()
    client.watch(run)
    assert isinstance(client.frame(), LiveSnapshot)
    return client


def control_view(*, paused: bool, stepping: bool = False) -> ControlView:
    """The control of a run at rest."""
    return ControlView(
        paused=paused,
        confirmed=paused,
        cannot=(),
        waiting=(),
        locks=(),
        breakpoints=(),
        autonomy="full",
        operator="none",
        active=(),
        stepping=stepping,
    )


def delta(client: LiveClient) -> LiveDelta:
    """The next frame, which must be a delta."""
    frame = client.frame()
    assert isinstance(frame, LiveDelta)
    return frame


async def test_changes_of_one_node_are_sent_as_its_last_state() -> None:
    """Many events, one entry; the counter tells how many visits there were."""
    backend = FakeBackend()
    backend.emit("r", RunStarted, **STARTED)
    client = watching(open_hub(backend), "r")
    for visit in range(1, 51):
        backend.emit("r", NodeEntered, path="root/a", visit=visit, kind="state", inputs={})
        backend.emit("r", NodeExited, path="root/a", visit=visit, outcome="done")
    frame = delta(client)
    assert list(frame.nodes) == ["root/a"]
    assert (frame.nodes["root/a"].status, frame.nodes["root/a"].visits) == ("done", 50)
    assert (frame.after, frame.seq) == (1, 101)
    assert client.frame() is None


async def test_a_client_that_does_not_read_costs_bounded_memory() -> None:
    """Log lines fall out at the front and are counted."""
    backend = FakeBackend()
    backend.emit("r", RunStarted, **STARTED)
    client = watching(open_hub(backend), "r")
    for number in range(LOG_LINES + 500):
        backend.emit("r", MessageLogged, path="root", level="info", message=str(number))
    frame = delta(client)
    assert (len(frame.log), frame.dropped) == (LOG_LINES, 500)
    assert frame.log[-1].text == str(LOG_LINES + 499)


async def test_deltas_join_without_a_gap() -> None:
    """Each begins where the one before ended."""
    backend = FakeBackend()
    backend.emit("r", RunStarted, **STARTED)
    client = watching(open_hub(backend), "r")
    ends = [1]
    for _ in range(3):
        backend.emit("r", MessageLogged, path="root", level="info", message="x")
        frame = delta(client)
        assert frame.after == ends[-1]
        ends.append(frame.seq)
    assert ends == [1, 2, 3, 4]


async def test_a_page_that_comes_in_the_middle_sees_what_is_active() -> None:
    """Also when the hub itself opened in the middle of the run."""
    backend = FakeBackend()
    backend.emit("r", RunStarted, **STARTED)
    for path in ("root", "root/left", "root/right"):
        backend.emit("r", NodeEntered, path=path, visit=1, kind="state", inputs={})
    client = open_hub(backend).join()
    client.watch("r")
    frame = client.frame()
    assert isinstance(frame, LiveSnapshot)
    assert {path for path, node in frame.nodes.items() if node.status == "active"} == {
        "root",
        "root/left",
        "root/right",
    }
    assert len(frame.log) == 4


async def test_the_clock_of_a_run_goes_on_between_its_events() -> None:
    """By wall time, while the run is on the real clock and not over."""
    backend, wall_s = FakeBackend(), [50.0]
    hub = open_hub(backend, wall_s)
    client = hub.join()
    client.watch("r")
    backend.emit("r", RunStarted, **STARTED)
    live = hub.live_run("r")
    at_start_s = hub.now_s(live)
    wall_s[0] += 2.5
    assert hub.now_s(live) == pytest.approx(at_start_s + 2.5)
    backend.emit("r", RunEnded, status="finished", outcome="finished")
    wall_s[0] += 100.0
    assert hub.now_s(live) == live.state.time_s


class _PausedBackend(FakeBackend):
    """A backend whose runs have a control that can be paused."""

    def __init__(self, control: ControlView) -> None:
        super().__init__()
        self.view = control

    def control(self, run_id: str) -> Control:
        return cast("Control", SimpleNamespace(view=lambda: self.view))


async def test_the_clock_of_a_paused_run_stands() -> None:
    """It goes on with the next step, and from where the run then is."""
    backend, wall_s = _PausedBackend(control_view(paused=True)), [50.0]
    hub = open_hub(backend, wall_s)
    client = hub.join()
    client.watch("r")
    backend.emit("r", RunStarted, **STARTED)
    live = hub.live_run("r")
    wall_s[0] += 2.5
    assert (hub.now_s(live), hub.ticking(live)) == (live.state.time_s, False)
    backend.view = control_view(paused=True, stepping=True)
    assert hub.ticking(live)


async def test_the_end_of_a_run_arrives_though_the_engine_files_it_later() -> None:
    """The end is told by an event first; the list of runs follows."""
    backend = FakeBackend()
    backend.emit("r", RunStarted, **STARTED)
    client = watching(open_hub(backend), "r")
    backend.emit("r", RunEnded, status="finished", outcome="finished")
    assert delta(client).runs[0].status == "running"
    backend.file("r", "finished")
    assert delta(client).runs[0].status == "finished"
    assert client.frame() is None


async def test_a_run_that_nobody_knows_shows_as_empty() -> None:
    """A link to a run that is gone."""
    client = watching(open_hub(FakeBackend()), "gone")
    assert client.frame() is None


async def test_a_whole_run_is_streamed_with_both_arms_active_at_once(serve: Serve) -> None:
    """Over a real websocket, from the start to the end."""
    async with serve(FakeBackend(step_s=0.08)) as served, served.live() as live:
        assert (await live.frame())["k"] == "hello"
        assert (await live.until("snapshot"))["runs"] == []
        run = await served.backend.start(TRANSFER.id, parameters={}, seed=1)
        await live.send({"k": "watch", "run": run})
        frame = await live.until("snapshot", run=run)
        nodes, together = dict(frame["nodes"]), False
        while not any(r["status"] == "finished" for r in frame["runs"]):
            frame = await live.until("delta")
            nodes |= frame["nodes"]
            together |= {nodes.get(f"root/pick/{arm}/descend", {}).get("status") for arm in ("left", "right")} == {
                "active"
            }
        assert together
        assert nodes["root"]["outcome"] == "finished"


async def test_a_client_that_never_reads_is_sent_away_and_disturbs_nobody(
    serve: Serve, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its buffers fill, it is closed, the hub forgets it; another client gets everything."""
    # A reader that the machine holds up for a moment is none that never reads.
    monkeypatch.setattr(sockets, "SEND_LIMIT_S", 1.0)
    backend = FakeBackend()
    backend.emit("r", RunStarted, **STARTED)
    async with serve(backend) as served, served.live("r") as reader:
        deaf = await join_and_never_read(served)
        await reader.until("snapshot", run="r")
        hub = hub_of(served.backend)
        last = 0
        async with asyncio.timeout(GUARD_S):
            while last == 0 or len(hub.clients) > 1:
                for _ in range(200):
                    backend.emit("r", MessageLogged, path="root", level="info", message="x" * 2000)
                last = (await reader.until("delta", run="r"))["seq"]
        deaf.close()
        assert last == backend.events("r")[-1].seq


async def join_and_never_read(served: Served) -> socket.socket:
    """Open a stream by hand, with a small buffer, and leave it at that."""
    host, port = served.origin.removeprefix("http://").split(":")
    loop, deaf = asyncio.get_running_loop(), socket.socket()
    deaf.setblocking(False)
    deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    await loop.sock_connect(deaf, (host, int(port)))
    request = (
        f"GET /api/v1/live HTTP/1.1\r\nHost: {host}:{port}\r\nOrigin: {served.origin}\r\nUpgrade: websocket\r\n"
        f"Connection: Upgrade\r\nSec-WebSocket-Key: {'A' * 22}==\r\nSec-WebSocket-Version: 13\r\n"
        f"Cookie: {served.cookie['Cookie']}\r\n\r\n"
    )
    await loop.sock_sendall(deaf, request.encode())
    assert b"101" in await loop.sock_recv(deaf, 200)
    watch = b'{"k":"watch","run":"r"}'
    await loop.sock_sendall(deaf, bytes([0x81, 0x80 | len(watch), 0, 0, 0, 0]) + watch)
    return deaf


def hub_of(backend: FakeBackend) -> LiveHub:
    """The hub that follows this backend."""
    callback = backend.subscribers()[0]
    hub = getattr(callback, "__self__", None)
    assert isinstance(hub, LiveHub)
    return hub


async def test_nonsense_on_the_stream_closes_it(serve: Serve) -> None:
    """1008, and the server lives on."""
    async with serve() as served, served.live() as live:
        await live.socket.send('{"k": "explode"}')
        with pytest.raises(ConnectionClosedError):
            await live.until("never")
        assert live.socket.close_code == 1008
        assert (await served.http.get("/api/v1/session")).status_code == 200


async def test_another_start_of_the_server_has_another_epoch(serve: Serve) -> None:
    """By which the page knows that it must fetch everything again; its cookie still opens."""
    epochs: list[str] = []
    for _ in range(2):
        async with serve() as served, served.live() as live:
            epochs.append((await live.frame())["epoch"])
    assert epochs[0] != epochs[1]


async def test_a_sweep_is_sent_as_it_is_now_also_to_a_page_that_comes_later() -> None:
    """Only its last state counts; one that has ended is told once."""
    hub = open_hub(FakeBackend())
    client = watching(hub, "")
    for done in range(3):
        hub.note_sweep("s.yaml", SweepLive(status="running", planned=9, done=done))
    newest = SweepsChanged(changed={"s.yaml": SweepLive(status="running", planned=9, done=2)})
    assert client.frame() == newest
    assert client.frame() is None
    later = watching(hub, "")
    assert later.dirty.is_set()
    assert later.frame() == newest
    end = SweepLive(planned=9, done=9)
    hub.note_sweep("s.yaml", end)
    assert client.frame() == SweepsChanged(changed={"s.yaml": end})
    assert watching(hub, "").frame() is None
