"""Plugging modules while the cell is open: each module is served under its own name, `trolley/plug_module`."""

from __future__ import annotations

from engine.messages import Message
from engine.skill import Service

MODULES_TOPIC = "cell/modules"
"""The topic with the latest `CellModules`."""


class ModuleState(Message, frozen=True, kw_only=True):
    """One module: its connector, empty while it is not plugged, and the parts that are on it while it is away.

    `kind` is what its own document calls it.
    """

    module: str
    kind: str
    connector: str = ""
    away: tuple[str, ...] = ()


class CellModules(Message, frozen=True, kw_only=True):
    """All modules of a cell in the order of its document, and the connectors that carry none."""

    modules: tuple[ModuleState, ...]
    free: tuple[str, ...]


class PlugModule(Service[ModuleState], frozen=True, kw_only=True):
    """Plug a module into a connector: what stands on it is in the cell when this returns.

    Without a `connector` it is the one that the cell document names. Parts that were on it when it was unplugged are on
    it again.
    """

    connector: str = ""


class UnplugModule(Service[ModuleState], frozen=True, kw_only=True):
    """Unplug a module: it leaves with its parts that are on it; those that are elsewhere stay in the cell.

    A run that has the module refuses it or, with `end_run`, is stopped first.
    """

    end_run: bool = False

    @property
    def ends_run(self) -> bool:
        """Whether the run that has the module is stopped first."""
        return self.end_run
