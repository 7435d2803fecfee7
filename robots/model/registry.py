"""Which robot models there are: a name in a cell document → the maker of its `RobotModel`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from difflib import get_close_matches

from engine.errors import CellError
from robots.model.panda import panda
from robots.model.robot_model import RobotModel

MODELS: Mapping[str, Callable[[], RobotModel]] = {"panda": panda}
"""Adding a robot is one file with a maker, and its line here."""


def model_by_name(name: str) -> RobotModel:
    """Return the robot model `name`.

    Raises:
        CellError: no such model (names the near ones), or its description is not installed.
    """
    maker = MODELS.get(name)
    if maker is None:
        near = get_close_matches(name, MODELS, n=1)
        hint = f"did you mean {near[0]}?" if near else f"known models: {', '.join(sorted(MODELS))}"
        raise CellError(f"no robot model is called {name}", where=name, hint=hint)
    return maker()
