"""A client of the real application over documents in a temporary project."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import httpx

from editor_web.app import new_app
from editor_web.security.authentication import load_access_tokens
from editor_web.security.login_sessions import LoginSessions
from engine.editing import DocumentRepository
from tests.editor_web.fake_backend import FakeBackend
from tests.engine.editing.edit_fixtures import STATES

HOST = "127.0.0.1:8642"
SHIFT_ID = "behaviors/shift.yaml"
SHIFT = """\
flexcell: 1
name: shift
# What it ends with.
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: first
    states:
      first: {state: test.Give, transitions: {a: second, b: second, c: bad}}   # begins
      second:
        state: flow.Wait
        with: {duration_s: 1}
        transitions: {done: good}
"""


class EditingClient:
    """Asks for JSON at `/api/v1/documents`, logged in as `role`."""

    def __init__(self, project: Path, *, role: str = "operator") -> None:
        self.project = project
        (project / "behaviors").mkdir(exist_ok=True)
        (project / SHIFT_ID).write_text(SHIFT, encoding="utf-8")
        self.access = load_access_tokens(project / "tokens")
        self.documents = DocumentRepository(project, STATES)
        backend = FakeBackend(documents=self.documents)
        self.sessions = LoginSessions(file=None, tokens="")
        self.app = new_app(backend, access=self.access, sessions=self.sessions, hosts=frozenset({HOST}), port=8642)
        token = self.access.operator if role == "operator" else self.access.viewer
        self.http = httpx.AsyncClient(
            transport=httpx.ASGITransport(app=self.app),
            base_url=f"http://{HOST}/api/v1",
            headers={"Authorization": f"Bearer {token}"},
        )

    @property
    def file(self) -> Path:
        """The file of the one document."""
        return self.project / SHIFT_ID

    async def get(self, path: str, **params: str) -> httpx.Response:
        """Ask for something."""
        return await self.http.get(path, params=params)

    async def post(self, path: str, body: Any) -> httpx.Response:
        """Send JSON."""
        return await self.http.post(path, json=body)

    async def opened(self) -> dict[str, Any]:
        """The document as the page gets it."""
        return (await self.get(f"/documents/{SHIFT_ID}")).json()

    async def save(self, text: str, base_hash: str) -> httpx.Response:
        """Write the document."""
        return await self.http.put(f"/documents/{SHIFT_ID}", json={"text": text, "base_hash": base_hash})
