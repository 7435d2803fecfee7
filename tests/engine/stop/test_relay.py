"""The relay's process with real sockets: STOP over HTTP and by signal, with lines, with and without an engine."""

from __future__ import annotations

import asyncio
import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass

import httpx

from engine.stop import StopEndpoint, StopLine, StopNotice, StopRelay
from tests.engine.stop.device import device, endpoint_of, post, posted


async def test_a_stop_over_http_reaches_the_device_and_the_engine_and_is_released_by_the_engine() -> None:
    notices: list[StopNotice] = []
    noted = asyncio.Event()

    async def note(notice: StopNotice) -> None:
        notices.append(notice)
        noted.set()

    async with StopRelay(host="127.0.0.1") as relay, device(relay) as arm:
        relay.on_stop(note)
        answer = await posted(endpoint_of(relay), reason="the door is open")
        await noted.wait()
        await asyncio.to_thread(arm.released.wait)
    assert answer.status_code == 200
    told = answer.json()
    # An engine that is slow to answer on a loaded machine counts as silent, and hears of it all the same.
    assert (told["stop"], told["acknowledged"], told["engine"] in ("informed", "silent")) == (1, True, True)
    assert [each["name"] for each in told["devices"]] == ["world"]
    assert arm.stops == ["the door is open"]
    assert [(notice.reason, notice.source) for notice in notices] == [("the door is open", "http")]


async def test_a_loop_that_is_blocked_delays_no_stop() -> None:
    async with StopRelay(host="127.0.0.1") as relay, device(relay) as arm:
        answers: list[httpx.Response] = []
        endpoint = endpoint_of(relay)
        thread = threading.Thread(target=lambda: answers.append(post(endpoint)))
        thread.start()
        # The loop is held here until the stop has been answered.
        thread.join()
        told = answers[0].json()
        latched = arm.line.latched
    assert (told["acknowledged"], told["engine"]) == (True, "silent")
    assert latched, "only the engine releases"


async def test_status_says_when_everything_rests() -> None:
    async with StopRelay(host="127.0.0.1") as relay, device(relay) as arm:
        arm.rests = False
        endpoint = endpoint_of(relay)
        first = (await posted(endpoint)).json()
        arm.rests = True
        status = first
        while not status["at_rest"]:
            status = (await posted(endpoint, path="/status")).json()
    assert (first["acknowledged"], first["at_rest"]) == (True, False)
    assert status["stop"] == first["stop"]


async def test_an_order_of_the_engine_latches_until_it_is_released() -> None:
    async with StopRelay() as relay, device(relay) as arm:
        stop = await relay.order("end of shift")
        assert stop == 1
        await asyncio.to_thread(arm.stopped.wait)
        assert arm.line.reason == "end of shift"
        relay.release(stop)
        await asyncio.to_thread(arm.released.wait)


async def test_a_wrong_token_stops_nothing_and_never_locks_the_right_one_out() -> None:
    async with StopRelay(host="127.0.0.1") as relay, device(relay) as arm:
        endpoint = endpoint_of(relay)
        wrong = [(await posted(endpoint, token="guess")).status_code for _ in range(20)]
        assert set(wrong) == {401}
        assert not arm.stops
        assert (await posted(endpoint)).json()["acknowledged"]


async def test_only_pages_of_this_server_may_ask() -> None:
    async with StopRelay(host="127.0.0.1") as relay:
        relay.allow_origins(["http://127.0.0.1:8642"])
        endpoint = endpoint_of(relay)
        body = json.dumps({"token": endpoint.token, "reason": "page"})

        def ask(origin: str) -> httpx.Response:
            return httpx.post(endpoint.url, content=body, headers={"Origin": origin}, trust_env=False)

        own = await asyncio.to_thread(ask, "http://127.0.0.1:8642")
        other = await asyncio.to_thread(ask, "http://127.0.0.1:9999")
    assert own.headers["access-control-allow-origin"] == "http://127.0.0.1:8642"
    assert other.status_code == 403
    assert "access-control-allow-origin" not in other.headers


async def test_connections_that_say_nothing_delay_no_stop() -> None:
    async with StopRelay(host="127.0.0.1") as relay, device(relay):
        endpoint = endpoint_of(relay)
        url = httpx.URL(endpoint.url)
        mute = [await asyncio.open_connection(url.host, url.port) for _ in range(400)]
        answer = await posted(endpoint)
        for _, writer in mute:
            writer.close()
    assert answer.json()["acknowledged"]


async def test_a_relay_that_is_killed_counts_as_a_stop() -> None:
    notices: list[StopNotice] = []
    told = asyncio.Event()

    async def note(notice: StopNotice) -> None:
        notices.append(notice)
        told.set()

    async with StopRelay() as relay, device(relay) as arm:
        relay.on_stop(note)
        relay.kill()
        await told.wait()
        await asyncio.to_thread(arm.stopped.wait)
        assert arm.stops == ["the stop line is cut: the stop relay has ended"]
        assert relay.lost_reason == "the stop relay has ended by SIGKILL"
    assert [notice.source for notice in notices] == ["loss"]


_ENGINE = """
import asyncio, os, signal, socket, sys, time
from engine.stop import StopRelay

async def main():
    async with StopRelay(host="127.0.0.1") as relay:
        line = relay.new_line("arm")
        socket.send_fds(socket.socket(fileno=int(sys.argv[1])), [b"x"], [line.fileno()])
        line.close()
        signal.signal(signal.SIGINT, lambda *_: None)
        with relay.watched_signals(at_once=sys.argv[2] == "serves"):
            print(relay.endpoint.url, relay.endpoint.token, flush=True)
            if sys.argv[2] == "blocks":
                time.sleep(600)
            await asyncio.sleep(600)

asyncio.run(main())
"""


@dataclass(kw_only=True)
class _Engine:
    """An engine in a process of its own; the test is its only device."""

    process: subprocess.Popen[bytes]
    endpoint: StopEndpoint
    connection: socket.socket
    line: StopLine

    async def stops_device(self) -> str:
        """Wait for a stop and return its reason."""
        return await asyncio.to_thread(self._wait)

    def _wait(self) -> str:
        while not (reason := self.line.poll()):
            select.select([self.connection], [], [])
        self.line.report_at_rest()
        return reason


@contextmanager
def engine_in_a_process(how: str) -> Generator[_Engine]:
    ours, theirs = socket.socketpair()
    command = [sys.executable, "-P", "-c", _ENGINE, str(theirs.fileno()), how]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    process = subprocess.Popen(command, pass_fds=(theirs.fileno(),), stdout=subprocess.PIPE, env=environment)
    theirs.close()
    assert process.stdout is not None
    url, token = process.stdout.readline().decode().split()
    _, descriptors, _, _ = socket.recv_fds(ours, 1, 1)
    connection = socket.socket(fileno=descriptors[0])
    try:
        yield _Engine(
            process=process,
            endpoint=StopEndpoint(url=url, token=token),
            connection=connection,
            line=StopLine(connection),
        )
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        connection.close()
        ours.close()


async def test_a_signal_that_a_blocked_engine_cannot_handle_stops_the_devices() -> None:
    with engine_in_a_process("blocks") as engine:
        engine.process.send_signal(signal.SIGINT)
        assert await engine.stops_device() == "interrupted by SIGINT; the engine does not answer"


async def test_a_signal_that_means_stop_waits_for_no_engine() -> None:
    """The loop of a server may turn, and yet be busy for long before it comes to its robots."""
    with engine_in_a_process("serves") as engine:
        engine.process.send_signal(signal.SIGINT)
        assert await engine.stops_device() == "interrupted by SIGINT"


async def test_a_frozen_engine_is_stopped_over_http() -> None:
    with engine_in_a_process("waits") as engine:
        engine.process.send_signal(signal.SIGSTOP)
        asking = asyncio.create_task(posted(engine.endpoint))
        assert await engine.stops_device() == "test"
        assert (await asking).json()["engine"] == "silent"


async def test_a_killed_engine_stops_the_devices_and_stop_is_still_answered() -> None:
    with engine_in_a_process("waits") as engine:
        engine.process.kill()
        assert await engine.stops_device() == "the engine has ended"
        asking = asyncio.create_task(posted(engine.endpoint))
        assert await engine.stops_device() == "test"
        told = (await asking).json()
    assert (told["acknowledged"], told["engine"]) == (True, "ended")
