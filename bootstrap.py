#!/usr/bin/env python3
"""Sets flexcell up in `.venv` from nothing but Python, then runs the demo cell or the tests.

python3 bootstrap.py demo              the demo cell with its dashboard
python3 bootstrap.py demo --headless   the demo behavior once, no browser
python3 bootstrap.py test              what must pass before a change lands; of the costly tests a sixth, by commit
python3 bootstrap.py test --all        all tests; with options of pytest, what these choose of them
python3 bootstrap.py test --fast       what needs no browser, process or physics: a few minutes
python3 bootstrap.py lock [--upgrade]  requirements/*.lock for what pyproject.toml asks for
"""

from __future__ import annotations

import ctypes.util
import hashlib
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
BIN = VENV / ("Scripts" if os.name == "nt" else "bin")
PYTHON = BIN / ("python.exe" if os.name == "nt" else "python")
# Python compiles what is imported when it first is, a third of all that is installed.
PIP_INSTALL = [PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile"]
DEMO = "behaviors/reconcycle/two_arm_transfer.yaml"
CELL = "behaviors/cells/dual_panda.yaml"
# What each lock holds beyond the runtime dependencies. Both hold what builds flexcell, so nothing unlocked is fetched.
PROJECT = ROOT / "pyproject.toml"
LOCKS = ROOT / "requirements"
LOCKED = {
    "development": ["--extra=all", "--extra=test", "--extra=bench", "--group=build", "--group=lock", "--group=audit"],
    "runtime": ["--extra=all", "--group=build"],
}
DIGEST = "# Requirements of pyproject.toml, SHA-256: "
COMPILE = [
    *("pip", "compile", "--quiet", "--universal", "--python-version=3.11", "--generate-hashes"),
    "--only-binary=:all:",
]
CHECKS = {
    "format": ["ruff", "format", "--check", "."],
    "lint": ["ruff", "check", "."],
    "types": ["pyright", "--warnings"],
    "layers": ["lint-imports"],
}
SLOW_CHECKS = {"advisories": ["python", ".ci/audit.py"]}
# Once, and not by each test process for itself.
COMPILE_KERNELS = ["python", "-m", "tests.compile_kernels"]
MESA_DRIVERS = ("*/dri/swrast_dri.so", "*/libgallium-*.so")
# Young objects, for Node. Its 16 MiB fill so often that the type checker spends a quarter of its time on clearing them;
# with 256 MiB it takes 9 % less than with 64.
NODE_OPTIONS = "--max-semi-space-size=256"
# Each process has a half of the files, one after the other, and takes from the other's where it is earlier at its end:
# what the tests of a file share is made once, and none waits for the other.
PYTEST = ["-m", "pytest", "-n", "2", "--dist", "worksteal", "-q", "--cpu"]
# For the table that `--cpu` prints; tests/cpu_times.py.
CPU_STAGES = "FLEXCELL_CPU_STAGES"
# Docs and decision: docs/decisions/0079-costly-tests-take-turns.md
TURNS = 6
# The first has no windows of its own, whose pages cost as much as the one that is tested.
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def main(arguments: list[str]) -> int:
    """Do what the first argument says and return the exit code."""
    if sys.version_info < (3, 11):  # noqa: UP036 - run by whatever Python there is
        return _fail(f"flexcell needs Python 3.11 or newer; this is {sys.version.split()[0]}")
    commands = {"demo": demo, "test": test, "lock": lock}
    if not arguments or arguments[0] not in commands:
        sys.stderr.write(__doc__ or "")
        return 2
    # A run starts hundreds of processes, and each would compile our modules for itself.
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    try:
        return commands[arguments[0]](arguments[1:])
    except subprocess.CalledProcessError as error:
        return _fail(f"`{' '.join(str(part) for part in error.cmd)}` failed with exit code {error.returncode}")
    except KeyboardInterrupt:
        return 130


def demo(options: list[str]) -> int:
    """Serve the demo cell, or run its behavior once with --headless."""
    install("runtime")
    if "--headless" in options:
        rest = [option for option in options if option != "--headless"]
        return _become([BIN / "flexcell", "run", DEMO, "--cell", CELL, "--clock", "virtual", *rest])
    return _become([BIN / "flexcell", "serve", "--cell", CELL, *options])


def test(options: list[str]) -> int:
    """Run lint, types, import contracts and the tests; pytest's own line is the last one."""
    os.environ.setdefault("NODE_OPTIONS", NODE_OPTIONS)
    spent: dict[str, float] = {}
    with _measured("set-up", spent):
        install("development")
    if "--fast" in options:
        options = ["-m", "fast", *(option for option in options if option != "--fast")]
        _run_checks(CHECKS, spent)
    else:
        options = _chosen_tests(options)
        with _measured("browser and graphics", spent):
            ensure_browser()
            ensure_graphics()
        began_s, earlier_s = _children_s(), sum(spent.values())
        # The type checker and the compiler of the kernels keep one processor busy each.
        with _beside([BIN / COMPILE_KERNELS[0], *COMPILE_KERNELS[1:]]):
            _run_checks({**CHECKS, **SLOW_CHECKS}, spent)
        spent["kernels"] = _children_s() - began_s - (sum(spent.values()) - earlier_s)
    os.environ[CPU_STAGES] = json.dumps(spent)
    return _become([PYTHON, *PYTEST, *options])


def _chosen_tests(options: list[str]) -> list[str]:
    """Return the options of pytest: those given, or the turn of the commit if there are none."""
    if options:
        return [option for option in options if option != "--all"]
    turn = turn_of_commit()
    _say(f"of the tests with browsers, processes or physics this is turn {turn}; `test --all` runs all")
    return [f"--turn={turn}"]


def turn_of_commit() -> str:
    """Return which turn of the costly tests a checkout has: another one for each commit, the first without git."""
    command = ["git", "rev-parse", "HEAD"]
    try:
        commit = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        commit = "0"
    return f"{int(commit, 16) % TURNS + 1}/{TURNS}"


def lock(options: list[str]) -> int:
    """Write the lock files; versions stay as they are where they still fit, unless --upgrade is given."""
    _make_venv()
    _check([*PIP_INSTALL, "--only-binary", ":all:", *_requirements(PROJECT)["dependency-groups"]["lock"]])
    _compile("development", options)
    # Constrained to the versions that the tests see.
    _compile("runtime", ["--constraint", str(_lock_file("development").relative_to(ROOT))])
    return 0


def install(name: str) -> None:
    """Make `.venv` with flexcell and exactly what the lock `name` holds, unless it is so already."""
    stamp = VENV / "flexcell-installed"
    state = _fingerprint()
    present = stamp.read_text(encoding="utf-8").split() if stamp.is_file() else [""]
    if present[0] == state and name in present[1:]:
        return
    require_current_lock(PROJECT, _lock_file(name))
    _make_venv()
    _say("installing flexcell and what it needs (a few minutes the first time)")
    install_locked(_lock_file(name), by_uv=name == "development")
    _check([*PIP_INSTALL, "--no-deps", "--no-build-isolation", "--editable", "."])
    # The development lock holds all of the runtime lock, in the same versions.
    stamp.write_text(" ".join([state, *LOCKED] if name == "development" else [state, name]), encoding="utf-8")


def install_locked(lock_file: Path, *, by_uv: bool) -> None:
    """Install what a lock holds; by uv, if it is one of the packages, with a quarter of pip's processor time."""
    # Each file has a hash in the lock, and none runs code of its own while it is installed.
    options = ["--require-hashes", "--only-binary", ":all:", "--requirement"]
    if by_uv:
        uv_alone = VENV / "uv.lock"
        uv_alone.write_text(lock_entry(lock_file, "uv"), encoding="utf-8")
        _check([*PIP_INSTALL, *options, uv_alone])
        command = [PYTHON, "-m", "uv", "pip", "install", "--quiet", "--python", PYTHON, *options, lock_file]
        if subprocess.run(command, check=False, cwd=ROOT).returncode == 0:
            return
        _say("uv could not install the packages, perhaps since it does not read pip's settings: pip does it")
    _check([*PIP_INSTALL, *options, lock_file])


def lock_entry(lock_file: Path, package: str) -> str:
    """Return the lines of a lock that hold one package: its version and its hashes."""
    lines = lock_file.read_text(encoding="utf-8").splitlines(keepends=True)
    starts = [number for number, line in enumerate(lines) if line.startswith(f"{package}==")]
    if len(starts) != 1:
        raise SystemExit(_fail(f"{lock_file.name} has {len(starts)} entries of {package} and not one"))
    (start,) = starts
    end = next((n for n in range(start + 1, len(lines)) if not lines[n].startswith(" ")), len(lines))
    return "".join(lines[start:end])


def require_current_lock(project: Path, lock_file: Path) -> None:
    """Refuse a lock that was made for other requirements than those of `project`."""
    first = lock_file.read_text(encoding="utf-8").partition("\n")[0] if lock_file.is_file() else ""
    if first != DIGEST + requirements_digest(project):
        relative = f"{lock_file.parent.name}/{lock_file.name}"
        problem = f"{relative} does not fit the requirements in {project.name}"
        raise SystemExit(_fail(f"{problem}: run `python3 bootstrap.py lock` and commit what it writes"))


def requirements_digest(project: Path) -> str:
    """Return the SHA-256 of all that a project file requires, and of nothing else in it."""
    return hashlib.sha256(json.dumps(_requirements(project), sort_keys=True).encode()).hexdigest()


def _requirements(project: Path) -> dict[str, Any]:
    # Imported here, since main() must be able to say that this Python is too old to have it.
    import tomllib

    data = tomllib.loads(project.read_text(encoding="utf-8"))
    names = ("requires-python", "dependencies", "optional-dependencies")
    required = {name: data["project"].get(name) for name in names}
    return required | {"build": data["build-system"]["requires"], "dependency-groups": data.get("dependency-groups")}


def ensure_browser() -> None:
    """Find a Chromium for the browser tests; as root on Debian, install one, without windows if there is."""
    if (
        os.environ.get("FLEXCELL_CHROMIUM")
        or shutil.which(BROWSERS[0])
        or _apt_installed(BROWSERS[0], "fonts-dejavu-core")
    ):
        return
    if not any(map(shutil.which, BROWSERS)) and not _apt_installed("chromium", "fonts-dejavu-core"):
        raise SystemExit(_fail("the browser tests need Chromium: install it, or set FLEXCELL_CHROMIUM to its path"))


def ensure_graphics() -> None:
    """Have depth images rendered in software; as root on Debian, install what is missing. Without it rays do."""
    present = ctypes.util.find_library("EGL") and any(map(_is_there, MESA_DRIVERS))
    if not present and not _apt_installed("libegl1", "libegl-mesa0", "libgl1-mesa-dri"):
        _say("OpenGL is not there; depth images are made by rays")


def _is_there(pattern: str) -> bool:
    return any(Path("/usr/lib").glob(pattern))


def _lock_file(name: str) -> Path:
    return LOCKS / f"{name}.lock"


def _compile(name: str, options: list[str]) -> None:
    """Write one lock: every version for every Python from 3.11 on, with hashes, without a registry's address."""
    file = _lock_file(name)
    environment = {**os.environ, "UV_CUSTOM_COMPILE_COMMAND": "python3 bootstrap.py lock"}
    command = [PYTHON, "-m", "uv", *COMPILE, *LOCKED[name], *options, "pyproject.toml", "--output-file", file]
    subprocess.run(command, check=True, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL)
    head = DIGEST + requirements_digest(PROJECT)
    file.write_text(f"{head}\n{file.read_text(encoding='utf-8')}", encoding="utf-8")


def _make_venv() -> None:
    if PYTHON.is_file():
        return
    if importlib.util.find_spec("ensurepip") is None:
        package = f"python{sys.version_info.major}.{sys.version_info.minor}-venv"
        if not _apt_installed(package):
            raise SystemExit(_fail(f"this Python cannot make virtual environments: install {package}"))
    _check([sys.executable, "-m", "venv", VENV])


def _apt_installed(*packages: str) -> bool:
    """Install packages as root on Debian; says whether they are there now."""
    if not shutil.which("apt-get") or not hasattr(os, "geteuid") or os.geteuid() != 0:
        return False
    _say(f"installing {', '.join(packages)}")
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    try:
        for command in (["update", "-qq"], ["install", "-y", "-qq", "--no-install-recommends", *packages]):
            subprocess.run(["apt-get", *command], check=True, env=environment, stdout=subprocess.DEVNULL)
    except subprocess.CalledProcessError:
        return False
    return True


def _fingerprint() -> str:
    """Return what the installation depends on: project file, locks, build hook and the front end's sources."""
    digest = hashlib.sha256()
    front_end = ROOT / "editor_web" / "frontend"
    sources = [p for p in front_end.rglob("*") if "node_modules" not in p.parts and p.is_file()]
    for path in (PROJECT, ROOT / "hatch_build.py", *map(_lock_file, LOCKED), *sorted(sources)):
        digest.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()


def _run_checks(checks: dict[str, list[str]], spent: dict[str, float]) -> None:
    for name, command in checks.items():
        started_s = time.monotonic()
        with _measured(name, spent):
            _check([BIN / command[0], *command[1:]])
        _say(f"{name}: {time.monotonic() - started_s:.0f} s, {spent[name]:.0f} s of processor time")


@contextmanager
def _measured(stage: str, spent: dict[str, float]) -> Generator[None]:
    """Note the processor time of all commands that are executed meanwhile, in seconds."""
    began_s = _children_s()
    yield
    spent[stage] = _children_s() - began_s


def _children_s() -> float:
    """Return the processor time of the commands that have ended; Windows does not tell it."""
    times = os.times()
    return times.children_user + times.children_system


@contextmanager
def _beside(command: list[str | Path]) -> Generator[None]:
    """Run a command beside what is done meanwhile; it must have succeeded in the end."""
    running = subprocess.Popen(command, cwd=ROOT)
    try:
        yield
        code = running.wait()
    except BaseException:
        running.terminate()
        running.wait()
        raise
    if code != 0:
        raise subprocess.CalledProcessError(code, command)


def _check(command: list[str | Path]) -> None:
    subprocess.run(command, check=True, cwd=ROOT)


def _become(command: list[str | Path]) -> int:
    """Go on as `command`, so that Ctrl-C and signals reach it alone and it can bring robots to rest."""
    os.chdir(ROOT)
    if os.name != "nt":
        os.execv(command[0], [str(part) for part in command])  # noqa: S606 - our own command
    return subprocess.run(command, check=False).returncode


def _say(text: str) -> None:
    sys.stderr.write(f"flexcell: {text}\n")


def _fail(text: str) -> int:
    sys.stderr.write(f"flexcell: {text}\n")
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
