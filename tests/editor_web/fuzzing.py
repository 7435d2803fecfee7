"""Requests of every kind, made from the description of the interface, at a served session with a real project."""

from __future__ import annotations

import asyncio
import hashlib
import logging
import os
import shutil
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

import requests
import schemathesis
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from schemathesis import GenerationMode
from schemathesis.config import SchemathesisConfig
from schemathesis.specs.openapi import checks

from editor_web.app import api
from editor_web.security.authentication import OPERATOR, VIEWER
from engine.runtime.run_options import RunOptions
from tests.editor_web.limits import GUARD_S
from tests.editor_web.workshop import NAP, NAP_ID, SHIFT, SHIFT_ID, Workshop

EXAMPLES = int(os.environ.get("FLEXCELL_FUZZ_EXAMPLES", "5"))
"""Requests of each kind for each operation; set the variable to fuzz for longer."""
Operation = tuple[str, str]
# Streams for as long as somebody listens.
ENDLESS: Operation = ("GET", "/api/v1/bus/echo")
# What the API says must be kept; `negative_data_rejection`: what breaks the schema is refused.
CHECKS: list[Any] = [
    getattr(checks, f"{name}_conformance") for name in ("status_code", "content_type", "response_schema")
]
CHECKS.append(checks.negative_data_rejection)  # pyright: ignore[reportUnknownMemberType] # partly typed
HOSTILE_PATHS = (
    "../../outside.yaml", "..%2f..%2foutside.yaml", "..%252f..%252foutside.yaml", "%2e%2e/%2e%2e/outside.yaml",
    "behaviors/../../outside.yaml", "behaviors/..\\..\\outside.yaml", "behaviors/%00.yaml", "behaviors/x.yaml%00.png",
    "/etc/passwd", "%2fetc%2fpasswd", "//etc/passwd", "behaviors", "behaviors/", ".", "..", "C:\\windows\\win.ini",
    "file:///etc/passwd", "behaviors/" + "a" * 5000 + ".yaml", "behaviors/" + "a/" * 300 + "x.yaml", "~/.ssh/id_rsa",
    "behaviors/\u202egnp.yaml", "behaviors/con.yaml", "behaviors/.hidden.yaml", "behaviors/link.yaml",
    "behaviors/folder/secret.yaml", "tokens", ".flexcell/journal", "behaviors/%f0%28%8c%28.yaml", "%", "%zz",
)  # fmt: skip

_document = api().openapi()
# Those that count as a refusal of what breaks the schema: 431 is that of an address that is too long to be read.
_REFUSALS = ["400", "401", "403", "404", "405", "406", "409", "415", "422", "428", "429", "431", "5xx"]
_config = cast("Any", SchemathesisConfig).from_dict(
    {"checks": {"negative_data_rejection": {"expected-statuses": _REFUSALS}}}
)
_schema = cast("Any", schemathesis.openapi.from_dict(_document, config=_config))
fuzzed = settings(
    max_examples=EXAMPLES,
    derandomize=True,
    database=None,
    deadline=None,
    suppress_health_check=cast("list[HealthCheck]", list(HealthCheck)),
)


def operations() -> list[Operation]:
    """Method and path of everything that the interface describes."""
    return sorted((method.upper(), path) for path, methods in _document["paths"].items() for method in methods)


def can_break(operation: Operation) -> bool:
    """Say whether there is anything that a request could break: a body, or a query with types."""
    method, path = operation
    described = _document["paths"][path][method.lower()]
    return "requestBody" in described or any(each["in"] == "query" for each in described.get("parameters", ()))


def broken(operation: Operation) -> st.SearchStrategy[Any]:
    """Requests that break the schema of an operation."""
    method, path = operation
    return _schema[path][method].as_strategy(generation_mode=GenerationMode.NEGATIVE)


@st.composite
def aimed(draw: st.DrawFn, operation: Operation, known: Mapping[str, tuple[str, ...]]) -> Any:
    """A request that keeps the schema, with names that exist in place of most of the names in it."""
    method, path = operation
    case = draw(_schema[path][method].as_strategy(generation_mode=GenerationMode.POSITIVE))
    for values in (case.path_parameters, case.body):
        if isinstance(values, dict):
            members = cast("dict[str, Any]", values)
            for name in sorted(members.keys() & known.keys()):
                members[name] = draw(st.sampled_from(known[name])) if draw(st.integers(0, 7)) > 0 else members[name]
    return case


class Log(logging.Handler):
    """Keeps what is logged as an error, or with a traceback."""

    def __init__(self) -> None:
        super().__init__()
        self.said: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep a record that nobody should ever cause from outside."""
        if record.levelno >= logging.ERROR or record.exc_info:
            self.said.append(self.format(record))


class Target:
    """A served session in `folder/project`, whose surroundings and log are watched."""

    def __init__(self, shop: Workshop, folder: Path, log: Log) -> None:
        self.shop, self.folder, self.log = shop, folder, log
        self.http = requests.Session()
        self.http.trust_env = False
        self.base = shop.running.url.rstrip("/")
        self._around = self.outside()

    def restore(self) -> None:
        """Put the behaviors back as they were, and have a run under way that waits before its first node."""
        for behavior_id, text in ((SHIFT_ID, SHIFT), (NAP_ID, NAP)):
            (self.shop.project / behavior_id).write_text(text, encoding="utf-8")
        self.shop.call(self.shop.session.stop_all(reason="the next operation"))
        self.shop.call(self.shop.session.recovery.release())
        self.shop.start(supervision=RunOptions(start_paused=True))

    @property
    def known(self) -> Mapping[str, tuple[str, ...]]:
        """Names that exist, by the parameter or member that takes them."""
        session = self.shop.session
        bus = tuple(entry.name for entry in self.shop.call(session.bus.listing()))
        runs = (session.runs()[0].id, *(run.id for run in session.interrupted()))
        digests = tuple(hashlib.sha256(text.encode()).hexdigest() for text in (SHIFT, ""))
        return {
            "behavior_id": (SHIFT_ID, NAP_ID),
            "document_id": (SHIFT_ID, NAP_ID, "behaviors/new.yaml"),
            "behavior": (SHIFT_ID, NAP_ID),
            "address": bus,
            "topic": bus,
            "id": ("behaviors/new.yaml", "behaviors/deep/er.yaml", *HOSTILE_PATHS),
            "run_id": runs,
            "run": runs,
            "path": ("root", "root/first", "root/both/left", "root/rest"),
            "outcome": ("a", "b", "done", "good"),
            "text": (SHIFT, "", "root: {}", SHIFT.replace("value: 1", "value: 2")),
            "base_hash": digests,
            "digest": digests,
        }

    def headers(self, role: str) -> dict[str, str]:
        """The bearer header of a role; none for ''."""
        access = self.shop.access
        token = {OPERATOR: access.operator, VIEWER: access.viewer}.get(role)
        return {"Authorization": f"Bearer {token}"} if token else {}

    def send(self, case: Any, *, role: str) -> Any:
        """Send a request; whatever the answer is, it is no traceback and comes in time."""
        answer = case.call(base_url=self.base, headers=self.headers(role), session=self.http, timeout=GUARD_S)
        self.require_calm(f"{case.method} {case.path}", int(answer.status_code), bytes(answer.content))
        return answer

    def require_calm(self, what: str, status: int, body: bytes) -> None:
        """No server error, no traceback in the answer or the log."""
        assert status < 500, (what, status, body[:500])
        assert b"Traceback" not in body, what
        said = tuple(self.log.said)
        self.log.said.clear()
        assert said == (), what

    def outside(self) -> dict[str, str]:
        """Every file around the project, with what is in it."""
        project = self.shop.project
        return {
            str(file): file.read_text(encoding="utf-8")
            for file in sorted(self.folder.rglob("*"))
            if file.is_file() and not file.is_relative_to(project)
        }

    def inside(self) -> dict[str, bytes]:
        """Every file of the project that a person put there, with what is in it."""
        behaviors = self.shop.project / "behaviors"
        return {str(file): file.read_bytes() for file in sorted(behaviors.rglob("*")) if file.is_file()}

    def require_untouched_surroundings(self) -> None:
        """Nothing was stored, changed or removed outside of the project, nor anything but YAML in its behaviors."""
        assert self.outside() == self._around
        top = {each.name for each in self.shop.project.iterdir()}
        assert top <= {"behaviors", ".flexcell", "tokens", "sessions"}, top
        assert {Path(name).suffix for name in self.inside()} <= {".yaml"}


@contextmanager
def opened_target(folder: Path, *, host: str) -> Generator[Target]:
    """Serve a project that has neighbours worth stealing, and a link that leads out of it."""
    project = folder / "project"
    (project / "behaviors").mkdir(parents=True)
    (folder / "outside.yaml").write_text(SHIFT, encoding="utf-8")
    (folder / "secrets").mkdir()
    (folder / "secrets" / "secret.yaml").write_text("password: 1", encoding="utf-8")
    (project / "behaviors" / "link.yaml").symlink_to(folder / "outside.yaml")
    (project / "behaviors" / "folder").symlink_to(folder / "secrets", target_is_directory=True)
    _leave_interrupted_run(project, host=host)
    log = Log()
    root = logging.getLogger()
    root.addHandler(log)
    try:
        with Workshop(host=host, project=project) as shop:
            yield Target(shop, folder, log)
    finally:
        root.removeHandler(log)


def _leave_interrupted_run(project: Path, *, host: str) -> None:
    """Leave the journal as an engine that died in the middle of a run would."""
    journal = project / ".flexcell"
    died = project.parent / "died"
    with Workshop(host=host, project=project) as shop:
        shop.start(NAP_ID)
        shop.call(asyncio.sleep(0))
        shutil.copytree(journal, died)
    shutil.rmtree(journal)
    died.rename(journal)
