"""Hostile packets to drivers and devices: `python -P -m benchmarks.fuzz_drivers [--packets N] [--protocol NAME]`.

Each protocol is fed in both directions: what a driver sends to the emulator of its device or to a server of ours, and
what a device sends to the codec of its driver. N packets for each, seeded; whole transports on sockets get fewer.
Nothing may crash, each refusal has a name, and no device moves without a command that permits it: the valid packets,
from which the others are made, have none. Fails, with the packet and its number, where one does.
"""

from __future__ import annotations

import argparse
import logging
import random
import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from benchmarks.comparison import machine
from benchmarks.fuzz_abb import ABB
from benchmarks.fuzz_devices import DEVICES
from benchmarks.fuzz_drivers_side import DRIVERS, TRANSPORTS
from benchmarks.fuzz_packets import mutated
from benchmarks.fuzz_reconcell import fuzz_reconcell_server
from benchmarks.fuzz_target import FuzzTarget
from engine.clock import run_virtual


@dataclass(kw_only=True)
class FuzzResult:
    """What a target did with its packets."""

    protocol: str
    direction: str
    packets: int = 0
    outcomes: Counter[str] = field(default_factory=Counter[str])
    crashes: list[str] = field(default_factory=list[str])
    moved: bool = False
    seconds: float = 0.0

    @property
    def row(self) -> str:
        """The result as a row of a table."""
        taken, ignored = self.outcomes[""], self.outcomes["ignored"]
        named = self.packets - taken - ignored - len(self.crashes)
        names = [name for name, _ in self.outcomes.most_common() if name not in ("", "ignored")]
        refused = f"{named:,}" + (f": {', '.join(names[:3])}" if names else "")
        moved = "yes" if self.moved else "none"
        rate = f"{self.packets / self.seconds:,.0f}"
        return (
            f"| {self.protocol} | {self.direction} | {self.packets:,} | {taken:,} | {refused} | {ignored:,} |"
            f" {len(self.crashes)} | {moved} | {rate} |"
        )


def fuzz(target: FuzzTarget, packets: int, *, seed: int) -> FuzzResult:
    """Feed a target."""
    result = FuzzResult(protocol=target.protocol, direction=target.direction, packets=packets)
    chance = random.Random(f"{target.protocol} {target.direction} {seed}")
    begun_s = time.perf_counter()
    for number in range(packets):
        packet = mutated(chance, target.valid)
        try:
            result.outcomes[target.feed(packet)] += 1
        except Exception as error:  # whatever it is, it is a crash, and the next packets count too
            result.crashes.append(f"packet {number}, {packet[:80].hex(' ')}: {type(error).__name__}: {error}")
    result.moved = target.has_moved()
    result.seconds = time.perf_counter() - begun_s
    return result


def table(results: Sequence[FuzzResult]) -> str:
    """Return the results as Markdown."""
    head = ("protocol", "fed", "packets", "taken", "refused by name", "ignored", "crashes", "motion", "packets/s")
    return "\n".join([f"| {' | '.join(head)} |", "|" + "---|" * len(head), *(result.row for result in results)])


def main() -> None:
    """Feed all protocols, or one, and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--packets", type=int, default=50_000, help="for each protocol and direction (default 50,000)")
    parser.add_argument("--protocol", help="feed this one only, such as softhand")
    parser.add_argument("--seed", type=int, default=1, help="of all packets (default 1)")
    options = parser.parse_args()
    # Each refusal is logged too.
    logging.disable(logging.CRITICAL)
    results: list[FuzzResult] = []
    for new_target in (*DEVICES, *DRIVERS, *ABB, *TRANSPORTS):
        target = new_target()
        if options.protocol in (None, target.protocol, target.protocol.removesuffix(" transport")):
            packets = max(1, round(target.share * options.packets))
            results.append(fuzz(target, packets, seed=options.seed))
            print(results[-1].row, file=sys.stderr)
    if options.protocol in (None, "reconcell"):
        outcomes, moved, seconds = run_virtual(fuzz_reconcell_server(options.packets, seed=options.seed))
        results.append(
            FuzzResult(
                protocol="reconcell",
                direction="to the device",
                packets=options.packets,
                outcomes=outcomes,
                moved=moved,
                seconds=seconds,
            )
        )
    if not results:
        parser.error(f"there is no protocol {options.protocol}")
    total = sum(result.packets for result in results)
    print(f"{total:,} packets; {machine()}.\n\n{table(results)}")
    failures = [f"{each.protocol}, {each.direction}: {crash}" for each in results for crash in each.crashes]
    failures += [f"{each.protocol}, {each.direction}: has moved" for each in results if each.moved]
    if failures:
        sys.exit("\n".join(failures[:20]))


if __name__ == "__main__":
    main()
