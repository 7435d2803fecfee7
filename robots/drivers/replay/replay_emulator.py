"""The emulator `replay`, as the entry point `flexcell.emulators` offers it, with its options."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import Emulator
from robots.drivers.emulation.stream_options import StreamOptions


class ReplayOptions(StreamOptions, frozen=True, kw_only=True):
    """What is replayed, how fast, and to whom."""

    file: Annotated[str, Meta(description="Capture that `--capture` has written")] = ""
    states: Annotated[str, Meta(description="Capture hand_states that belongs to one of hand_commands")] = ""
    pace: Annotated[
        float, Meta(ge=0.0, le=100.0, description="Share of the recorded delays before each answer; 0 for none")
    ] = 1.0
    receiver: Annotated[
        str, Meta(description="IPv4 address to which datagrams are sent; needed where the capture has some")
    ] = ""


REPLAY_EMULATOR = Emulator(
    kind="replay",
    summary="Any device, as a capture of its connection recorded it; answers what was recorded and nothing else",
    options=ReplayOptions,
    serve="robots.drivers.replay.serve_replay:serve_replay",
)
