"""Why a controller does not move, by what Robot Web Services say of it."""

from __future__ import annotations

from robots.drivers.abb.abb_faults import AbbFault
from robots.drivers.abb.rws.rws_state import PanelState, RwsState

_PANEL: dict[PanelState, tuple[AbbFault, str]] = {
    "emergencystop": (AbbFault.EMERGENCY_STOP, "the emergency stop is active"),
    "emergencystopreset": (
        AbbFault.EMERGENCY_STOP,
        "the button is released, and the stop is not confirmed: press Motors On at the cabinet",
    ),
    "sysfail": (AbbFault.CONTROLLER_ERROR, "system failure"),
    "guardstop": (AbbFault.GUARD_STOP, "a safeguard is open"),
    "motoroff": (AbbFault.DRIVES_OFF, "the motors are off"),
    "init": (AbbFault.DRIVES_OFF, "the controller starts"),
}
_MODES = {
    "MANR": "manual with reduced speed",
    "MANF": "manual with full speed",
    "AUTO_CH": "the change to automatic is not confirmed on the FlexPendant",
    "MANF_CH": "the change to manual with full speed is not confirmed on the FlexPendant",
    "INIT": "the controller starts",
    "UNDEF": "the mode is not defined",
}
_BEFORE_MODE = ("emergencystop", "emergencystopreset", "sysfail")
RECOVERABLE = frozenset({AbbFault.DRIVES_OFF, AbbFault.PROGRAM_STOPPED})
"""What motors on, the program pointer at main and a start of the program end, when a person asks for it."""


def rws_fault(state: RwsState, *, since_event: int) -> tuple[AbbFault, str] | None:
    """Return the cause with details, among them the newest error after `since_event`; None if it can move.

    In manual mode a released enabling device shows as a guard stop too: the mode is the cause.
    """
    cause = _cause(state)
    event = state.latest_error
    if cause is None or event is None or event.number <= since_event:
        return cause
    return cause[0], f"{cause[1]}; event {event.code}: {event.title}"


def _cause(state: RwsState) -> tuple[AbbFault, str] | None:
    panel = _PANEL.get(state.panel)
    if panel is not None and state.panel in _BEFORE_MODE:
        return panel
    if state.mode != "AUTO":
        return AbbFault.MANUAL_MODE, _MODES[state.mode]
    if panel is not None:
        return panel
    if state.execution != "running":
        return AbbFault.PROGRAM_STOPPED, "RAPID is stopped"
    return None
