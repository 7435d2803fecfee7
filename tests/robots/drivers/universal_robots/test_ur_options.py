"""Which client the driver has, and what it says where the library is missing."""

from __future__ import annotations

import msgspec
import pytest

from robots.drivers.arm.joint_controller import ControllerLost
from robots.drivers.universal_robots.ur_faults import UrFault, lost
from robots.drivers.universal_robots.ur_joint_controller import UrJointController
from robots.drivers.universal_robots.ur_options import (
    DASHBOARD_S,
    LONGEST_SILENCE_S,
    PROGRAM_END_S,
    UrOptions,
    UrPorts,
)


def options(**given: object) -> UrOptions:
    """Return options as a cell document gives them."""
    return msgspec.convert({"kind": "universal_robots", "host": "127.0.0.254", **given}, UrOptions)


def test_the_library_is_the_client_by_default() -> None:
    assert options().client == "ur_rtde"


def test_other_ports_need_the_script_client() -> None:
    assert options(client="script", ports={"rtde": 42004}).ports == UrPorts(rtde=42004)
    with pytest.raises(msgspec.ValidationError, match="`ports` needs `client: script`"):
        options(ports={"rtde": 42004})


def test_a_missing_library_is_named_with_the_client_that_needs_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> object:
        raise ModuleNotFoundError(f"No module named {name!r}")

    monkeypatch.setattr("importlib.import_module", missing)
    with pytest.raises(ControllerLost, match=r"^no client library: ") as raised:
        UrJointController(options()).connect()
    assert "choose `client: script`" in raised.value.hint
    assert raised.value.hint == lost(UrFault.NO_CLIENT_LIBRARY, "").hint


def test_a_process_that_ends_a_program_is_not_called_silent() -> None:
    longest_s = DASHBOARD_S + PROGRAM_END_S + DASHBOARD_S
    assert longest_s < LONGEST_SILENCE_S < 0.7 * options().process_silence_s
    assert options(process_silence_s=LONGEST_SILENCE_S).process_silence_s == LONGEST_SILENCE_S
    with pytest.raises(msgspec.ValidationError, match=r"Expected `float` >= 0\.6"):
        options(process_silence_s=0.5)
