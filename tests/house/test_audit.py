"""What is known against locked packages fails the tests, unless it is allowed for a time; no network is a word."""

from __future__ import annotations

import datetime as dt
import importlib.util
import json
import sys
from collections.abc import Generator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from types import ModuleType
from typing import Any

import pytest

import bootstrap

TODAY = dt.date(2026, 11, 22)
LOCK = "elkjs-of-python==1.0 --hash=sha256:" + "0" * 64
OSV: object = {
    "vulns": [
        {
            "id": "PYSEC-1",
            "aliases": ["CVE-1"],
            "summary": "",
            "details": "",
            "affected": [],
            "modified": "2026-01-01T00:00:00Z",
        }
    ]
}
NPM: object = json.loads(
    '{"elkjs": [{"id": 1, "url": "x/GHSA-1", "title": "It leaks", "severity": "high", "vulnerable_versions": "<9",'
    ' "cwe": [], "cvss": {}}]}'
)


def _audit() -> Any:
    spec = importlib.util.spec_from_file_location("audit", bootstrap.ROOT / ".ci" / "audit.py")
    assert spec is not None
    assert spec.loader is not None
    module: ModuleType = importlib.util.module_from_spec(spec)
    # Dataclasses look their module up by its name.
    sys.modules["audit"] = module
    spec.loader.exec_module(module)
    return module


audit = _audit()


@contextmanager
def service(*, post: object, get: object = None) -> Generator[str]:
    """An advisory service that knows one thing, at the address it gives."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            self.rfile.read(int(self.headers["content-length"]))
            self._send(post)

        def do_GET(self) -> None:
            self._send(get)

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the base class's name
            """Say nothing."""

        def _send(self, answer: object) -> None:
            body = json.dumps(answer).encode()
            self.send_response(200)
            self.send_header("content-type", "application/json")
            self.send_header("content-length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = Thread(target=server.serve_forever, name="advisories")
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}"
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture
def lock(tmp_path: Path) -> Path:
    """A lock of one package."""
    file = tmp_path / "one.lock"
    file.write_text(LOCK, encoding="utf-8")
    return file


def test_an_advisory_of_a_python_package_is_found(lock: Path) -> None:
    """With all the names it goes by."""
    with service(post=OSV) as url:
        (found,) = audit.python_advisories(lock, f"--osv-url={url}/v1/query")
    assert str(found) == "elkjs-of-python: PYSEC-1, CVE-1; no version mends it"


def test_an_advisory_of_an_npm_package_is_found() -> None:
    """By the versions it is about."""
    versions = {"versions": {"0.12.1": {"name": "elkjs", "version": "0.12.1"}}, "name": "elkjs"}
    with service(post=NPM, get=versions) as url:
        (found,) = audit.npm_advisories(f"--registry={url}")
    assert str(found) == "elkjs: GHSA-1; It leaks in <9"


def test_nothing_known_against_npm_packages_is_nothing() -> None:
    """And not a service that does not answer."""
    with service(post={}) as url:
        assert audit.npm_advisories(f"--registry={url}") == []


def test_a_service_that_is_not_there_is_no_answer(lock: Path) -> None:
    """For both."""
    with service(post={}) as gone:
        pass
    with pytest.raises(audit.NoAnswer):
        audit.python_advisories(lock, f"--osv-url={gone}/v1/query")
    with pytest.raises(audit.NoAnswer):
        audit.npm_advisories(f"--registry={gone}")


def test_a_tool_that_fails_by_itself_is_no_missing_network(tmp_path: Path) -> None:
    """Else nobody would see that nothing is asked any more."""
    with pytest.raises(RuntimeError, match="pip_audit"):
        audit.python_advisories(tmp_path / "none.lock")


def test_what_is_allowed_is_allowed_until_its_last_day() -> None:
    """By package and any of its names."""
    known = audit.Advisory(package="a", ids=("PYSEC-1", "CVE-1"), remedy="none")
    allowed = audit.Exemption(id="CVE-1", package="a", reason="we do not call it", expires=TODAY)
    other = audit.Exemption(id="CVE-1", package="b", reason="we do not call it", expires=TODAY)
    assert audit.unmet([known], [allowed], TODAY) == []
    assert audit.unmet([known], [other], TODAY) == [known]
    assert audit.unmet([known], [allowed], TODAY + dt.timedelta(days=1)) == [known]


def test_the_list_of_what_is_allowed_can_be_read() -> None:
    """Each entry with a reason and a last day."""
    audit.read_exemptions(audit.ALLOWED.read_text(encoding="utf-8"))
    with pytest.raises(ValueError, match="CVE-1 of a has no reason"):
        audit.read_exemptions('[[allowed]]\nid = "CVE-1"\npackage = "a"\nreason = " "\nexpires = 2026-11-22\n')
    with pytest.raises(TypeError, match="expires"):
        audit.read_exemptions('[[allowed]]\nid = "CVE-1"\npackage = "a"\nreason = "it is not called"\n')


@pytest.mark.parametrize(
    ("answer", "code", "said"), [("known", 1, "failed"), ("none", 0, "passed"), ("no", 0, "skipped")]
)
def test_the_word_and_the_exit_code(
    answer: str, code: int, said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Failed with the list, passed, or skipped because no service answers."""

    def ask() -> list[Any]:
        if answer == "no":
            raise audit.NoAnswer
        return [audit.Advisory(package="a", ids=("CVE-1",), remedy="mended in 2")] if answer == "known" else []

    monkeypatch.setattr(audit, "SOURCES", {"packages": ask})
    assert audit.main() == code
    printed = capsys.readouterr().out
    assert f"audit: packages {said}" in printed
    assert ("a: CVE-1; mended in 2" in printed) == (answer == "known")
