"""Pages are told when a document changes on disk."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Collection, Mapping
from pathlib import Path

import websockets.asyncio.client

from editor_web.live.document_watch import DocumentWatch
from engine.editing import DocumentRepository, text_hash
from engine.registry import load_states
from tests.editor_web.conftest import Serve
from tests.editor_web.editing_client import SHIFT, SHIFT_ID
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S
from tests.engine.project_folder import STATE, ProjectFolder


def test_a_look_tells_what_has_changed_since_the_last_one(tmp_path: Path) -> None:
    documents = DocumentRepository(tmp_path, {})
    watch = DocumentWatch(documents, changed=lambda _: None, is_needed=lambda: True)
    documents.create(SHIFT_ID)
    assert watch.look() == {}
    assert watch.look() == {}
    (tmp_path / SHIFT_ID).write_text(SHIFT)
    (tmp_path / "behaviors/other.yaml").write_text(SHIFT + "# other\n")
    assert watch.look() == {SHIFT_ID: text_hash(SHIFT), "behaviors/other.yaml": text_hash(SHIFT + "# other\n")}
    documents.delete(SHIFT_ID)
    assert watch.look() == {SHIFT_ID: None}


async def test_a_change_while_no_page_is_open_is_reported_to_the_next_one(tmp_path: Path) -> None:
    """A page that connects may have loaded what was there before the change."""
    documents = DocumentRepository(tmp_path, {})
    documents.create(SHIFT_ID)
    asked, changes = asyncio.Event(), asyncio.Queue[Mapping[str, str | None]]()
    is_open = False

    def is_watched() -> bool:
        asked.set()
        return is_open

    watch = DocumentWatch(documents, changed=changes.put_nowait, is_needed=is_watched, period_s=0.001)
    watch.open()
    (tmp_path / SHIFT_ID).write_text(SHIFT)
    async with asyncio.timeout(GUARD_S):
        await asked.wait()
        is_open = True
        assert await changes.get() == {SHIFT_ID: text_hash(SHIFT)}
    await watch.close()


async def test_modules_that_a_run_executes_are_loaded_anew_after_it(tmp_path: Path) -> None:
    """However often the watch looks meanwhile."""
    folder = ProjectFolder(tmp_path)
    module = folder.module()
    folder.allow(module)
    catalogue = load_states(tmp_path)
    looks, reloaded = asyncio.Queue[frozenset[str]](), asyncio.Event()
    is_running = True

    def are_used(modules: Collection[str]) -> bool:
        looks.put_nowait(frozenset(modules))
        return is_running

    documents = DocumentRepository(tmp_path, catalogue)
    watch = DocumentWatch(
        documents,
        changed=lambda _: None,
        reloaded=reloaded.set,
        are_used=are_used,
        is_needed=lambda: True,
        period_s=0.001,
    )
    watch.open()
    (tmp_path / f"{module}.py").write_text(STATE.replace('("done",)', '("done", "lost")'), encoding="utf-8")
    async with asyncio.timeout(GUARD_S):
        for _ in range(3):
            assert await looks.get() == {module}
        assert not reloaded.is_set()
        assert catalogue[f"{module}:Nod"].outcomes == ("done",)
        is_running = False
        await reloaded.wait()
    assert catalogue[f"{module}:Nod"].outcomes == ("done", "lost")
    await watch.close()


async def test_an_open_page_hears_of_a_change_on_disk(serve: Serve, tmp_path: Path) -> None:
    documents = DocumentRepository(tmp_path / "project", {})
    documents.create(SHIFT_ID)
    async with serve(FakeBackend(step_s=0.02, documents=documents)) as served:
        address = f"ws://{served.running.url.removeprefix('http://')}api/v1/live"
        headers = {**served.cookie, "Origin": served.origin}
        async with (
            asyncio.timeout(GUARD_S),
            websockets.asyncio.client.connect(address, additional_headers=headers, proxy=None) as page,
        ):
            frame = json.loads(await page.recv())
            (tmp_path / "project" / SHIFT_ID).write_text(SHIFT)
            while frame["k"] != "documents":
                frame = json.loads(await page.recv())
    assert frame["changed"].keys() == {SHIFT_ID}
