"""The pytest plugin `flexcell`: replays recordings as tests, and runs behaviors in tests.

Every `*.mcap` in the folders of the ini option `flexcell_recordings` or of `--flexcell-recordings`
is a test that replays it; its failure is the first difference. Fixtures: `flexcell_run` runs a
behavior file headless in virtual time, `flexcell_replay` replays a recording.

The engine is imported on use, not at the top: pytest loads the plugin in every
environment that has this package, mostly without using it. The project file counts that stands in the
root folder of pytest, or above it.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

_OPTION = "flexcell_recordings"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options for recording folders."""
    parser.addini(_OPTION, "folders with flexcell recordings that are replayed as tests", type="paths", default=[])
    parser.getgroup("flexcell").addoption(
        "--flexcell-recordings",
        action="append",
        default=[],
        dest=_OPTION,
        metavar="DIR",
        help="replay the flexcell recordings in this folder as tests; may be repeated",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker, and collect the folders given on the command line."""
    config.addinivalue_line("markers", "flexcell_replay: a recording that is replayed; set automatically")
    for folder in _given(config):
        if folder not in config.args:
            config.args.append(folder)


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect a recording in one of the folders."""
    if file_path.suffix != ".mcap" or not any(file_path.is_relative_to(folder) for folder in _folders(parent.config)):
        return None
    from engine.testing.recording_tests import RecordingTestFile

    return RecordingTestFile.from_parent(parent, path=file_path)  # pyright: ignore[reportUnknownMemberType]


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


def _folders(config: pytest.Config) -> list[Path]:
    kept: list[Path] = config.getini(_OPTION)
    return [folder.resolve() for folder in (*kept, *(config.invocation_params.dir / each for each in _given(config)))]


def _given(config: pytest.Config) -> list[str]:
    given: list[str] = config.getoption(_OPTION) or []
    return given
