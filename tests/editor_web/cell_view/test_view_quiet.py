"""Standard output belongs to the command line: viser, which greets there, says nothing on it."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Event

import pytest

from editor_web.cell_view.rendering.viser_gateway import new_viser_server


def test_viser_says_nothing_though_other_threads_put_standard_output_back(capsys: pytest.CaptureFixture[str]) -> None:
    ending, original = Event(), sys.stdout

    def put_back() -> None:
        while not ending.is_set():
            sys.stdout = original

    with ThreadPoolExecutor(1) as threads:
        putting_back = threads.submit(put_back)
        try:
            new_viser_server("key").stop()
        finally:
            ending.set()
        putting_back.result()
    assert capsys.readouterr().out == ""
