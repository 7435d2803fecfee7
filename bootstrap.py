#!/usr/bin/env python3
"""Sets flexcell up in `.venv` from nothing but Python, then runs the demo cell or the tests.

python3 bootstrap.py demo              the demo cell with its dashboard
python3 bootstrap.py demo --headless   the demo behavior once, no browser
python3 bootstrap.py test              everything that must pass
"""

from __future__ import annotations

import ctypes.util
import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
BIN = VENV / ("Scripts" if os.name == "nt" else "bin")
PYTHON = BIN / ("python.exe" if os.name == "nt" else "python")
DEMO = "behaviors/reconcycle/two_arm_transfer.yaml"
CELL = "behaviors/cells/dual_panda.yaml"
MESA_DRIVERS = ("*/dri/swrast_dri.so", "*/libgallium-*.so")
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def main(arguments: list[str]) -> int:
    """Do what the first argument says and return the exit code."""
    if sys.version_info < (3, 11):  # noqa: UP036 - run by whatever Python there is
        return _fail(f"flexcell needs Python 3.11 or newer; this is {sys.version.split()[0]}")
    if not arguments or arguments[0] not in ("demo", "test"):
        sys.stderr.write(__doc__ or "")
        return 2
    try:
        if arguments[0] == "demo":
            return demo(arguments[1:])
        return test(arguments[1:])
    except subprocess.CalledProcessError as error:
        return _fail(f"`{' '.join(str(part) for part in error.cmd)}` failed with exit code {error.returncode}")
    except KeyboardInterrupt:
        return 130


def demo(options: list[str]) -> int:
    """Serve the demo cell, or run its behavior once with --headless."""
    install("all")
    if "--headless" in options:
        rest = [option for option in options if option != "--headless"]
        return _become([BIN / "flexcell", "run", DEMO, "--cell", CELL, "--clock", "virtual", *rest])
    return _become([BIN / "flexcell", "serve", "--cell", CELL, *options])


def test(options: list[str]) -> int:
    """Run lint, types, import contracts and the tests; pytest's own line is the last one."""
    install("all,test,bench")
    ensure_browser()
    ensure_graphics()
    for name, command in (
        ("format", ["ruff", "format", "--check", "."]),
        ("lint", ["ruff", "check", "."]),
        ("types", ["pyright", "--warnings"]),
        ("layers", ["lint-imports"]),
    ):
        started_s = time.monotonic()
        _check([BIN / command[0], *command[1:]])
        _say(f"{name}: {time.monotonic() - started_s:.0f} s")
    return _become([PYTHON, "-m", "pytest", "-n", "2", "-q", *options])


def install(extras: str) -> None:
    """Make `.venv` with flexcell and `extras`, unless it is as the project's files ask already."""
    stamp = VENV / "flexcell-installed"
    state = _fingerprint()
    present = stamp.read_text(encoding="utf-8").split() if stamp.is_file() else [""]
    if present[0] == state and set(extras.split(",")) <= set(present[1:]):
        return
    if not PYTHON.is_file():
        _make_venv()
    _say("installing flexcell and what it needs (a few minutes the first time)")
    _check([PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-e", f".[{extras}]"])
    stamp.write_text(" ".join([state, *extras.split(",")]), encoding="utf-8")


def ensure_browser() -> None:
    """Find a Chromium for the browser tests; as root on Debian, install one."""
    if os.environ.get("FLEXCELL_CHROMIUM") or any(shutil.which(name) for name in BROWSERS):
        return
    if shutil.which("apt-get") and hasattr(os, "geteuid") and os.geteuid() == 0:
        _apt("chromium", "fonts-dejavu-core")
        return
    raise SystemExit(_fail("the browser tests need Chromium: install it, or set FLEXCELL_CHROMIUM to its path"))


def ensure_graphics() -> None:
    """Have depth images rendered in software; as root on Debian, install what is missing. Without it rays do."""
    present = ctypes.util.find_library("EGL") and any(map(_is_there, MESA_DRIVERS))
    if present or not shutil.which("apt-get") or not hasattr(os, "geteuid") or os.geteuid() != 0:
        return
    try:
        _apt("libegl1", "libegl-mesa0", "libgl1-mesa-dri")
    except subprocess.CalledProcessError:
        _say("OpenGL cannot be installed; depth images are made by rays")


def _is_there(pattern: str) -> bool:
    return any(Path("/usr/lib").glob(pattern))


def _make_venv() -> None:
    if importlib.util.find_spec("ensurepip") is None:
        package = f"python{sys.version_info.major}.{sys.version_info.minor}-venv"
        if shutil.which("apt-get") and hasattr(os, "geteuid") and os.geteuid() == 0:
            _apt(package)
        else:
            raise SystemExit(_fail(f"this Python cannot make virtual environments: install {package}"))
    _check([sys.executable, "-m", "venv", VENV])


def _apt(*packages: str) -> None:
    _say(f"installing {', '.join(packages)}")
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for command in (["update", "-qq"], ["install", "-y", "-qq", "--no-install-recommends", *packages]):
        subprocess.run(["apt-get", *command], check=True, env=environment, stdout=subprocess.DEVNULL)


def _fingerprint() -> str:
    """What the installation depends on: the project file, the build hook and the front end's sources."""
    digest = hashlib.sha256()
    front_end = ROOT / "editor_web" / "frontend"
    sources = [p for p in front_end.rglob("*") if "node_modules" not in p.parts and p.is_file()]
    for path in (ROOT / "pyproject.toml", ROOT / "hatch_build.py", *sorted(sources)):
        digest.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()


def _check(command: list[str | Path]) -> None:
    subprocess.run(command, check=True, cwd=ROOT)


def _become(command: list[str | Path]) -> int:
    """Go on as `command`, so that Ctrl-C and signals reach it alone and it can bring robots to rest."""
    os.chdir(ROOT)
    if os.name != "nt":
        os.execv(command[0], [str(part) for part in command])
    return subprocess.run(command, check=False).returncode


def _say(text: str) -> None:
    sys.stderr.write(f"flexcell: {text}\n")


def _fail(text: str) -> int:
    sys.stderr.write(f"flexcell: {text}\n")
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
