"""The contract of a kind of tool: what checks, states, teaching and the page know of it.

The engine knows no kind by name. Models that are installed (`engine.cell.robot_models`) offer their kinds;
`tool_kinds()` there returns them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from engine.messages import Message
from engine.skill import Action
from engine.state import State


@dataclass(frozen=True, kw_only=True)
class ToolKind:
    """A kind of tool at the flange of an arm; its model and its simulation are loaded when they are needed.

    Attributes:
        name: One word, as in `left/gripper`: the last word of its bus address, the kind of name that a parameter of
            a state declares (`cell_name`), and the parameter of its own states that names the arm.
        measured: The message of its topic `<arm>/<name>/state`; its field `held` says whether it holds something.
        hold: Name of the state that makes it hold a part: `held` or `missed`.
        release: Name of the state that makes it release a part; its first successful outcome ends the release.
        check: Name of the state that checks whether it holds its part: `held` or `lost`.
        mechanisms: By the `kind` of a mechanism in `tool.yaml`, where its model is found, `module:NAME`.
        release_goal: The goal that makes it release what it holds, from `<arm>/<name>`; None if no goal does that.
        simulation: Where the simulated world finds what simulates it, `module:NAME`.
        switched: Where the driver of tools on digital outputs finds what serves one, `module:NAME`; empty where such a
            tool makes no sense.
        states: The states that come with it; those of the installed package of states need not be listed.
    """

    name: str
    measured: type[Message]
    hold: str
    release: str
    check: str
    mechanisms: Mapping[str, str]
    simulation: str
    switched: str = ""
    states: tuple[type[State], ...] = ()
    release_goal: Action[Any, Any] | None = None
