"""A viser server that nobody looks at: what was drawn can be read from it."""

from __future__ import annotations

from collections.abc import Generator

import pytest
import viser

from editor_web.cell_view.rendering.viser_gateway import new_viser_server


@pytest.fixture
def server() -> Generator[viser.ViserServer]:
    """Of its own for each test."""
    opened = new_viser_server("key")
    yield opened
    opened.stop()
