"""Loopback addresses that tests claim."""

from __future__ import annotations

import socket

from robots.drivers.franka.emulation.control_cabinet import inner_address
from tests.robots.own_address import CLAIM_PORT, own_address


def test_an_address_that_another_process_claims_is_left_out() -> None:
    start, _, last = own_address().rpartition(".")
    following = f"{start}.{int(last) + 2}"
    with socket.socket() as claim:
        claim.bind((following, CLAIM_PORT))
        assert own_address() != following


def test_what_stands_behind_an_address_is_never_an_address_of_its_own() -> None:
    upper = {int(own_address().split(".")[1]) for _ in range(20)}
    assert max(upper) < 128 <= min(int(inner_address(f"127.{each}.0.2").split(".")[1]) for each in upper)
