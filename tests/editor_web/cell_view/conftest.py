"""A viser server that nobody looks at: what was drawn can be read from it."""

from __future__ import annotations

from collections.abc import Generator

import pytest
import viser

from editor_web.cell_view.lock import new_server


@pytest.fixture
def server() -> Generator[viser.ViserServer]:
    """Of its own for each test."""
    opened = new_server("key")
    yield opened
    opened.stop()
