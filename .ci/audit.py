"""Asks whether anything is known against the packages that are locked, Python's and npm's.

Exits with 1 and a list where `.ci/advisories.toml` does not allow what was found. A service that does not answer in
time is reported as `skipped`, and no failure: without a network nothing can be asked.
"""

from __future__ import annotations

import datetime as dt
import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

ROOT = Path(__file__).resolve().parent.parent
# The build hook knows how npm is called; it is no part of what is installed.
sys.path.insert(0, str(ROOT))

import hatch_build  # noqa: E402

LOCK = ROOT / "requirements" / "development.lock"
ALLOWED = ROOT / ".ci" / "advisories.toml"
LIMIT_S = 60.0
# What pip-audit's traceback has when it reaches no service.
NETWORK_FAILURE = "requests.exceptions."


class NoAnswer(Exception):
    """No advisory service answered, or not about all packages."""


@dataclass(frozen=True, kw_only=True, order=True)
class Advisory:
    """What is known against one package, by all the names it has."""

    package: str
    ids: tuple[str, ...]
    remedy: str

    def __str__(self) -> str:
        """One line of the list."""
        return f"{self.package}: {', '.join(self.ids)}; {self.remedy}"


@dataclass(frozen=True, kw_only=True)
class Exemption:
    """An advisory that is accepted for a time."""

    id: str
    package: str
    reason: str
    expires: dt.date


def read_exemptions(text: str) -> list[Exemption]:
    """Read the allow-list.

    Raises:
        TypeError: An entry has not all of the fields, or others.
        ValueError: An entry has no reason.
    """
    exemptions = [Exemption(**entry) for entry in tomllib.loads(text).get("allowed", [])]
    for exemption in exemptions:
        if not exemption.reason.strip():
            raise ValueError(f"{exemption.id} of {exemption.package} has no reason: say why it does not hurt here")
    return exemptions


def unmet(found: Iterable[Advisory], exemptions: Sequence[Exemption], today: dt.date) -> list[Advisory]:
    """Return what no exemption covers today."""
    valid = {(each.package, each.id) for each in exemptions if today <= each.expires}
    return [each for each in found if not any((each.package, name) in valid for name in each.ids)]


def python_advisories(lock: Path, *options: str, limit_s: float = LIMIT_S) -> list[Advisory]:
    """Ask about all Python packages of a lock.

    Raises:
        NoAnswer: The service cannot be reached, is too slow, or leaves a package out.
    """
    # OSV, since pip-audit takes a package that PyPI does not answer about for one without advisories.
    command = [sys.executable, "-m", "pip_audit", "--requirement", str(lock), "--disable-pip", "--require-hashes"]
    command += ["--vulnerability-service", "osv", "--format", "json", "--progress-spinner", "off", "--timeout", "5"]
    report = _report([*command, *options], dict(os.environ), limit_s=limit_s)
    if any("skip_reason" in each for each in report["dependencies"]):
        raise NoAnswer
    return sorted(_of_python(each["name"], known) for each in report["dependencies"] for known in each["vulns"])


def npm_advisories(*options: str, limit_s: float = LIMIT_S) -> list[Advisory]:
    """Ask about all packages of the page, those that only build it too.

    Raises:
        NoAnswer: The service cannot be reached or is too slow.
    """
    arguments = ("audit", "--json", "--package-lock-only", "--fetch-retries=0", *options)
    report = _report(*hatch_build.npm_call(*arguments), limit_s=limit_s)
    if "message" in report:
        raise NoAnswer
    # A package that is named only for what it depends on has texts there, and that other package its own entry.
    known = [via for each in report["vulnerabilities"].values() for via in each["via"] if isinstance(via, dict)]
    return sorted({_of_npm(via) for via in known})


def main() -> int:
    """Ask both services and print what they say."""
    exemptions, today = read_exemptions(ALLOWED.read_text(encoding="utf-8")), dt.datetime.now(tz=dt.UTC).date()
    problems = [problem for name, ask in SOURCES.items() for problem in _asked(name, ask, exemptions, today)]
    for problem in problems:
        print(f"  {problem}")
    if problems:
        print(f"audit: take a version without it, or say in {ALLOWED.relative_to(ROOT)} why it does not hurt here")
    return 1 if problems else 0


def _asked(name: str, ask: Asking, exemptions: Sequence[Exemption], today: dt.date) -> list[Advisory]:
    try:
        found = ask()
    except NoAnswer:
        print(f"audit: {name} skipped, no advisory service answers")
        return []
    problems = unmet(found, exemptions, today)
    print(f"audit: {name} {'failed' if problems else 'passed'}, {len(found)} known, {len(problems)} not allowed")
    return problems


def _report(command: Sequence[str], environment: dict[str, str], *, limit_s: float) -> dict[str, Any]:
    """Return what a tool writes as JSON; its exit code says the same for advisories and for no network."""
    try:
        done = subprocess.run(
            command,
            cwd=hatch_build.SOURCE,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=limit_s,
        )
    except subprocess.TimeoutExpired as error:
        raise NoAnswer from error
    try:
        return cast("dict[str, Any]", json.loads(done.stdout))
    except json.JSONDecodeError as error:
        if NETWORK_FAILURE in done.stderr:
            raise NoAnswer from error
        # A tool that is broken or not there must not look like a network that is not there.
        raise RuntimeError(f"`{' '.join(command)}` failed: {done.stderr.strip()[-1000:]}") from error


def _of_python(package: str, known: dict[str, Any]) -> Advisory:
    fixed = ", ".join(known["fix_versions"])
    remedy = f"mended in {fixed}" if fixed else "no version mends it"
    return Advisory(package=package, ids=(known["id"], *known["aliases"]), remedy=remedy)


def _of_npm(via: dict[str, Any]) -> Advisory:
    return Advisory(
        package=via["name"], ids=(via["url"].rpartition("/")[2],), remedy=f"{via['title']} in {via['range']}"
    )


Asking = Callable[[], list[Advisory]]
SOURCES: dict[str, Asking] = {"Python packages": lambda: python_advisories(LOCK), "npm packages": npm_advisories}

if __name__ == "__main__":
    sys.exit(main())
