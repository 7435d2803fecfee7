"""The relay's own process: receives STOP over HTTP and by signals and dispatches it.

One thread, one event loop that runs nothing else: no document, request or subscriber of the engine can delay it.
"""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import socket
import sys
from contextlib import suppress

from engine.stop.dispatcher import StopDispatcher
from engine.stop.stop_http import new_http_protocol

_PRIORITY = 10


async def _serve(engine: socket.socket, signals: socket.socket, listener: socket.socket | None) -> None:
    dispatcher = StopDispatcher(engine, signals)
    server = None
    if listener is not None:
        loop = asyncio.get_running_loop()
        server = await loop.create_server(new_http_protocol(dispatcher), sock=listener, backlog=1024)
    dispatcher.begin()
    await dispatcher.over
    if server is not None:
        server.close()


def main() -> None:
    """Run the relay on the descriptors of engine, signals and, for STOP over HTTP, the bound socket."""
    # A terminal's Ctrl-C reaches the whole process group; the relay acts on the signals' socket only.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    engine_fd, signals_fd, *http_fd = (int(argument) for argument in sys.argv[1:])
    with suppress(AttributeError, OSError):
        # When the system does not permit this scheduling policy, the default one remains.
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(_PRIORITY))
    gc.freeze()
    engine, signals = socket.socket(fileno=engine_fd), socket.socket(fileno=signals_fd)
    listener = socket.socket(fileno=http_fd[0]) if http_fd else None
    asyncio.run(_serve(engine, signals, listener))
