"""What a past moment in the 3D view costs: `python -P benchmarks/recording_seek.py RUN.mcap [--moments N]`.

Moments at random of a recording, as it is and as it was while it grew: how long opening takes, finding and decoding
what there is to draw, and the whole way from asking until it is drawn and sent for a page that is connected.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import resource
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import Writer

from editor_web.cell_view import CellView, PastViewState
from editor_web.cell_view.recorded_scene import RecordedScene
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.recording import part_file
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.viser_page import viser_page


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recording", type=Path)
    parser.add_argument("--moments", type=int, default=300)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        growing = part_file(Path(folder) / options.recording.name)
        _ungrouped(options.recording, growing)
        for what, file in (("finished", options.recording), ("growing", growing)):
            print(f"{what}, {file.stat().st_size / 1e6:.1f} MB")
            _finding(file, options.positions)
            asyncio.run(_drawing(file, options.positions))


def _ungrouped(finished: Path, target: Path) -> None:
    """Write a recording again as it lies while it grows: without chunks and index."""
    with finished.open("rb") as source, target.open("wb") as stream:
        reader, writer = make_reader(source), Writer(stream, use_chunking=False)
        writer.start()
        channels: dict[int, int] = {}
        for schema, channel, message in reader.iter_messages():
            if channel.id not in channels and schema is not None:
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, number)
            writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)


def _finding(file: Path, positions: int) -> None:
    started_s = time.perf_counter()
    run = RecordedScene([file])
    from_s, until_s = run.span_s
    latest = LatestMessages()
    run.show(latest, from_s)
    print(f"  opened, and its first moment found, in {(time.perf_counter() - started_s) * 1e3:.1f} ms")
    chance = random.Random(1)
    _report("found and decoded", positions, lambda: run.show(latest, chance.uniform(from_s, until_s)))
    run.close()


async def _drawing(file: Path, positions: int) -> None:
    backend = FakeBackend()
    backend.recorded["run"] = (file,)
    view = CellView(backend, shadows=False)
    await asyncio.to_thread(view.open)
    await view.subscribe()
    loop = asyncio.get_running_loop()
    reported: asyncio.Queue[PastViewState] = asyncio.Queue()

    def report(state: PastViewState) -> None:
        loop.call_soon_threadsafe(reported.put_nowait, state)

    async with viser_page(view, "one") as page:
        reading = asyncio.create_task(page.until(lambda: False))
        chance, took_s = random.Random(2), list[float]()
        until_s = 1.0
        for _ in range(positions):
            started_s = time.perf_counter()
            view.show_past("one", "run", chance.uniform(0.0, until_s), report=report)
            state = await reported.get()
            took_s.append(time.perf_counter() - started_s)
            until_s = state.until_s
            # As somebody who scrubs: 20 a second.
            await asyncio.sleep(max(0.0, 0.05 - took_s[-1]))
        reading.cancel()
    await view.unsubscribe()
    await asyncio.to_thread(view.close)
    _print("asked for, drawn and sent; the first", took_s[:1])
    _print("asked for, drawn and sent; the others", took_s[1:])
    print(f"  largest memory of this process {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3:.0f} MB")


def _report(what: str, times: int, work: Callable[[], None]) -> None:
    took_s: list[float] = []
    for _ in range(times):
        started_s = time.perf_counter()
        work()
        took_s.append(time.perf_counter() - started_s)
    _print(what, took_s)


def _print(what: str, took_s: list[float]) -> None:
    ordered = sorted(took_s)
    median, most = ordered[len(ordered) // 2], ordered[int(len(ordered) * 0.99)]
    print(f"  {what}: {median * 1e3:.1f} ms, 99th percentile {most * 1e3:.1f} ms")


if __name__ == "__main__":
    main()
