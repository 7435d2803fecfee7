"""As many connections as there are file descriptors for."""

from __future__ import annotations

import resource

import pytest

from editor_web.transport import capacity
from editor_web.transport.capacity import MAX_CONNECTIONS, connection_limit, raise_descriptor_limit


@pytest.fixture
def limits(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Soft and hard limit of a process with 20 open files."""
    pair = [1024, 4096]

    def getrlimit(_: int) -> tuple[int, int]:
        return pair[0], pair[1]

    def setrlimit(_: int, new: tuple[int, int]) -> None:
        pair[:] = new

    monkeypatch.setattr(resource, "getrlimit", getrlimit)
    monkeypatch.setattr(resource, "setrlimit", setrlimit)
    monkeypatch.setattr(capacity, "_open_descriptors", lambda: 20)
    return pair


def test_the_limit_is_raised_as_far_as_allowed(limits: list[int]) -> None:
    """To the hard one; without a hard one, to what is enough."""
    raise_descriptor_limit()
    assert limits == [4096, 4096]
    limits[:] = [1024, resource.RLIM_INFINITY]
    raise_descriptor_limit()
    assert limits == [65_536, resource.RLIM_INFINITY]


def test_few_descriptors_allow_few_connections(limits: list[int], caplog: pytest.LogCaptureFixture) -> None:
    """And that is said."""
    limits[:] = [4096, 4096]
    assert (connection_limit(), caplog.text) == (MAX_CONNECTIONS, "")
    limits[:] = [100, 100]
    assert connection_limit() == (100 - 20 - 12) // 2
    assert "ulimit -n" in caplog.text
