"""Somebody who watches the 3D view, in a process of its own: `viewer.py URL TOKEN [--browser]`.

By default a websocket client that reads all that the view sends; with `--browser` Chromium, which
also draws it. It prints `ready`, watches until its input is closed, then prints as JSON what it got.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import shutil
import sys

import viser
import websockets.asyncio.client
from websockets.typing import Subprotocol

from benchmarks.login_link import login_link

_BROWSERS = ("chromium", "chromium-browser", "google-chrome")


async def read_all(url: str, token: str) -> dict[str, int]:
    """Read until the input is closed."""
    got = {"messages": 0, "bytes": 0}
    async with websockets.asyncio.client.connect(
        f"{url.replace('http', 'ws', 1)}cell/",
        subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
        additional_headers={"Authorization": f"Bearer {token}"},
        max_size=None,
        compression=None,
        proxy=None,
    ) as socket:

        async def read() -> None:
            async for message in socket:
                got["messages"] += 1
                got["bytes"] += len(message)

        reading = asyncio.create_task(read())
        print("ready", flush=True)
        await asyncio.to_thread(sys.stdin.read)
        reading.cancel()
        await asyncio.wait((reading,))
    return got


def watch_in_browser(url: str, token: str) -> dict[str, int]:
    """Let Chromium draw the view until the input is closed."""
    from playwright.sync_api import WebSocket, sync_playwright

    got = {"messages": 0, "bytes": 0}

    def count(data: str | bytes) -> None:
        got["messages"] += 1
        got["bytes"] += len(data)

    def connected(socket: WebSocket) -> None:
        socket.on("framereceived", count)

    found = os.environ.get("FLEXCELL_CHROMIUM") or next(filter(None, map(shutil.which, _BROWSERS)), None)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        page = browser.new_page()
        page.on("websocket", connected)
        page.goto(login_link(url, token))
        page.goto(f"{url}cell/")
        page.locator("canvas").first.wait_for(timeout=60_000)
        print("ready", flush=True)
        # Playwright hands out what happened while it is waited in.
        os.set_blocking(sys.stdin.fileno(), False)
        while sys.stdin.buffer.read() != b"":
            page.wait_for_timeout(100)
        browser.close()
    return got


def main() -> None:
    """Watch, then print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("url")
    parser.add_argument("token")
    parser.add_argument("--browser", action="store_true")
    options = parser.parse_args()
    if options.browser:
        got = watch_in_browser(options.url, options.token)
    else:
        got = asyncio.run(read_all(options.url, options.token))
    print(json.dumps(got), flush=True)


if __name__ == "__main__":
    main()
