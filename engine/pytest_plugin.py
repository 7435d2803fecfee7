"""The pytest plugin `flexcell`: recordings and sweeps as tests, and behaviors in tests.

Every `*.mcap` in the folders of the ini option `flexcell_recordings` or of `--flexcell-recordings` is a test that
replays it; its failure is the first difference. Every sweep document in those of `flexcell_sweeps` or
`--flexcell-sweeps` is a test that executes it and fails unless it reaches what it requires. Fixtures: `flexcell_run`
runs a behavior file headless in virtual time, `flexcell_replay` replays a recording.

The engine is imported on use, not at the top: pytest loads the plugin in every
environment that has this package, mostly without using it. The project file counts that stands in the
root folder of pytest, or above it.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

_RECORDINGS, _SWEEPS = "flexcell_recordings", "flexcell_sweeps"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options for folders of recordings and of sweeps."""
    group = parser.getgroup("flexcell")
    for option, what in ((_RECORDINGS, "flexcell recordings, replayed"), (_SWEEPS, "flexcell sweeps, executed")):
        parser.addini(option, f"folders with {what} as tests", type="paths", default=[])
        group.addoption(
            f"--{option.replace('_', '-')}",
            action="append",
            default=[],
            dest=option,
            metavar="DIR",
            help=f"a folder with {what} as tests; may be repeated",
        )


def pytest_configure(config: pytest.Config) -> None:
    """Register the markers, and collect the folders given on the command line."""
    config.addinivalue_line("markers", "flexcell_replay: a recording that is replayed; set automatically")
    config.addinivalue_line("markers", "flexcell_sweep: a sweep that is executed; set automatically")
    for folder in (*_given(config, _RECORDINGS), *_given(config, _SWEEPS)):
        if folder not in config.args:
            config.args.append(folder)


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect a recording or sweep in one of the folders."""
    if file_path.suffix == ".mcap" and _is_in(file_path, parent.config, _RECORDINGS):
        from engine.testing.recording_tests import RecordingTestFile

        return RecordingTestFile.from_parent(parent, path=file_path)  # pyright: ignore[reportUnknownMemberType]
    if file_path.suffix == ".yaml" and _is_in(file_path, parent.config, _SWEEPS):
        from engine.sweep.sweep_tests import SweepTestFile, is_sweep_file

        if is_sweep_file(file_path):
            return SweepTestFile.from_parent(parent, path=file_path)  # pyright: ignore[reportUnknownMemberType]
    return None


@pytest.fixture
def flexcell_run(tmp_path: Path, pytestconfig: pytest.Config) -> object:
    """Run a behavior file headless in virtual time: an `engine.testing.RunBehavior`."""
    from engine.registry import load_states
    from engine.testing import run_behavior

    return partial(run_behavior, catalogue=load_states(pytestconfig.rootpath), store=tmp_path / "flexcell-store.db")


@pytest.fixture
def flexcell_replay(pytestconfig: pytest.Config) -> object:
    """Replay a recording, with another version of its behavior if one is given: an `engine.testing.ReplayFile`."""
    from engine.registry import load_states
    from engine.testing import replay_file

    return partial(replay_file, catalogue=load_states(pytestconfig.rootpath))


def _is_in(file: Path, config: pytest.Config, option: str) -> bool:
    kept: list[Path] = config.getini(option)
    folders = (*kept, *(config.invocation_params.dir / each for each in _given(config, option)))
    return any(file.is_relative_to(folder.resolve()) for folder in folders)


def _given(config: pytest.Config, option: str) -> list[str]:
    given: list[str] = config.getoption(option) or []
    return given
