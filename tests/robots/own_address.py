"""Loopback addresses that no other test of this machine has, in whatever process: ports of controllers are fixed."""

from __future__ import annotations

import itertools
import os
import socket
from collections import deque

# Below the ports that the system gives away, and no port of a device.
CLAIM_PORT = 7771
_MOST_CLAIMS = 200
_LAST = 126
_MIDDLE = 256
_HALF = 127
_places = itertools.count(os.getpid() * _LAST)
_claims: deque[socket.socket] = deque()


def own_address() -> str:
    """Return an address, with the next one and the same two in the upper half of the network (`inner_address`).

    A socket that stays bound there claims them, so that two processes never get the same, whatever their numbers.
    """
    for place in _places:
        address = _address(place)
        claim = socket.socket()
        try:
            claim.bind((address, CLAIM_PORT))
        except OSError:
            claim.close()
            continue
        _claims.append(claim)
        while len(_claims) > _MOST_CLAIMS:
            _claims.popleft().close()
        return address
    raise AssertionError("the numbers do not end")


def _address(place: int) -> str:
    place, last = divmod(place, _LAST)
    upper, middle = divmod(place, _MIDDLE)
    return f"127.{1 + upper % _HALF}.{middle}.{2 * last + 2}"
