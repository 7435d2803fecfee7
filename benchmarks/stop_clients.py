"""200 clients that ask a server all the time: `python -m benchmarks.stop_clients HOST PORT TOKEN`."""

from __future__ import annotations

import asyncio
import sys

_CLIENTS = 200
_PAUSE_S = 0.1


async def ask(host: str, port: int, token: str) -> None:
    """Ask for the runs over one connection, again and again; a new one where it is lost."""
    head = f"GET /api/v1/runs HTTP/1.1\r\nHost: {host}:{port}\r\nAuthorization: Bearer {token}\r\n\r\n".encode()
    while True:
        try:
            reader, writer = await asyncio.open_connection(host, port)
            while True:
                writer.write(head)
                await reader.readexactly(_length(await reader.readuntil(b"\r\n\r\n")))
        except (OSError, asyncio.IncompleteReadError):
            await asyncio.sleep(_PAUSE_S)


def _length(head: bytes) -> int:
    lines = head.lower().split(b"\r\n")
    return next((int(line.partition(b":")[2]) for line in lines if line.startswith(b"content-length")), 0)


async def main() -> None:
    """Ask until killed."""
    host, port, token = sys.argv[1:4]
    await asyncio.gather(*(ask(host, int(port), token) for _ in range(_CLIENTS)))


if __name__ == "__main__":
    asyncio.run(main())
