"""Relays between an emulated controller and its driver that spoil what passes, seeded and counted."""

from __future__ import annotations

import random
import selectors
import socket
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from types import TracebackType
from typing import Self

from benchmarks.fuzz_packets import mutated

_MOST_BYTES = 65536
_WAKE_S = 0.05
Address = tuple[str, int]


@dataclass
class Spoiler:
    """Decides what is sent instead of a packet. `share` of the packets get garbage beside or instead of them.

    `harmless` says of garbage whether its receiver must not act on it; None for any garbage.
    """

    seed: int
    share: float = 0.0
    harmless: Callable[[bytes], bool] | None = None
    garbage: int = 0
    passed: int = 0
    chance: random.Random = field(init=False)

    def __post_init__(self) -> None:
        """Begin."""
        self.chance = random.Random(self.seed)

    def spoiled(self, packet: bytes) -> list[bytes]:
        """Return what is sent."""
        self.passed += 1
        if self.chance.random() >= self.share:
            return [packet]
        sent = [mutated(self.chance, (packet,)) for _ in range(self.chance.choice((1, 1, 3)))]
        sent = [each for each in sent if each and (self.harmless is None or self.harmless(each))]
        self.garbage += len(sent)
        if self.harmless is None and self.chance.random() < 0.5:
            return sent
        sent.insert(self.chance.randrange(len(sent) + 1), packet)
        return sent


class _Relay:
    """A thread that passes on what it receives, from the begin to the end of the block."""

    def __init__(self, to_driver: Spoiler, to_device: Spoiler) -> None:
        self.to_driver = to_driver
        self.to_device = to_device
        self._ends = threading.Event()
        self._selector = selectors.DefaultSelector()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._ends.set()
        self._thread.join()
        for key in tuple(self._selector.get_map().values()):
            assert isinstance(key.fileobj, socket.socket)
            key.fileobj.close()
        self._selector.close()

    def spoil(self, share: float) -> None:
        """Spoil this share of what passes from now on."""
        self.to_driver.share = self.to_device.share = share

    def _run(self) -> None:
        while not self._ends.is_set():
            for key, _ in self._selector.select(_WAKE_S):
                key.data(key.fileobj)


class DatagramRelay(_Relay):
    """Where a controller sends to; passes it on from an address of the controller, as drivers require.

    Args:
        inner: The address to which the controller sends.
        controller: The host of the controller.
        driver: Where the driver listens.
        to_driver: Spoils measurements.
        to_device: Spoils answers.
    """

    def __init__(
        self, inner: Address, *, controller: str, driver: Address, to_driver: Spoiler, to_device: Spoiler
    ) -> None:
        super().__init__(to_driver, to_device)
        self._driver = driver
        self._device: Address | None = None
        self._inside, self._outside = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
        self._inside.bind(inner)
        self._outside.bind((controller, 0))
        self._selector.register(self._inside, selectors.EVENT_READ, self._measured)
        self._selector.register(self._outside, selectors.EVENT_READ, self._answered)

    def _measured(self, inside: socket.socket) -> None:
        try:
            packet, self._device = inside.recvfrom(_MOST_BYTES)
        except ConnectionError:
            return  # the controller had gone when an answer was sent
        for each in self.to_driver.spoiled(packet):
            self._outside.sendto(each, self._driver)

    def _answered(self, outside: socket.socket) -> None:
        try:
            packet = outside.recv(_MOST_BYTES)
        except ConnectionError:
            return  # the driver does not listen
        if self._device is not None:
            for each in self.to_device.spoiled(packet):
                self._inside.sendto(each, self._device)


class StreamRelay(_Relay):
    """A TCP port in front of another; what passes is spoiled as it comes, so that its packets lose their borders."""

    def __init__(self, outer: Address, *, inner: Address, to_driver: Spoiler, to_device: Spoiler) -> None:
        super().__init__(to_driver, to_device)
        self._inner = inner
        self._selector.register(socket.create_server(outer), selectors.EVENT_READ, self._accept)

    def _accept(self, server: socket.socket) -> None:
        driver, _ = server.accept()
        device = socket.create_connection(self._inner)
        for each in (driver, device):
            each.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._selector.register(driver, selectors.EVENT_READ, partial(self._pass, device, self.to_device))
        self._selector.register(device, selectors.EVENT_READ, partial(self._pass, driver, self.to_driver))

    def _pass(self, target: socket.socket, spoiler: Spoiler, source: socket.socket) -> None:
        try:
            received = source.recv(_MOST_BYTES)
            for each in spoiler.spoiled(received) if received else ():
                target.sendall(each)
        except OSError:
            received = b""
        if not received:
            for each in (source, target):
                if each.fileno() >= 0:
                    self._selector.unregister(each)
                    each.close()
