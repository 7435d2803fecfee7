"""The driver `abb_irc5`, as the entry point `flexcell.drivers` offers it. Opens nothing."""

from __future__ import annotations

from engine.cell.drivers import Driver
from engine.skill import Capability
from robots.drivers.abb.abb_options import AbbOptions

_CAPABILITIES = frozenset[Capability]({"trajectory", "outputs"})
_GUIDED_CAPABILITIES = frozenset[Capability]({"trajectory", "outputs", "stream"})


def _capabilities(options: AbbOptions) -> frozenset[Capability]:
    return _GUIDED_CAPABILITIES if options.egm is not None else _CAPABILITIES


ABB_IRC5 = Driver(
    kind="abb_irc5",
    drives="arm",
    options=AbbOptions,
    capabilities=_CAPABILITIES,
    capabilities_with=_capabilities,
    digital_outputs=lambda options: 0 if options.gripper is None else 1,
    digital_inputs=lambda options: 0 if options.rws is None else len(options.rws.inputs),
    enabling=(
        "Connects the motion port, and the gripper if there is one, and sends a stop request, which clears a path that "
        "the controller may still have. With Robot Web Services it then switches the motors on and starts the program "
        "at main, where they are off. With EGM it begins to answer the controller, which holds the arm. Releases no "
        "stop: that is done at the controller."
    ),
    ports={"motion": 11000, "state": 11002, "gripper": 11004, "rws": 80, "egm (UDP, here)": 6510},
    proven=(
        "Never run on hardware. Tested over sockets against its emulator, which is written from the same "
        "description of simple_message and abb_driver: no client or controller of others has confirmed either. "
        "abb-robot-client commands the emulated Robot Web Services, and guides the emulated arm over EGM."
    ),
    page="docs/how-to/connect-an-abb-irc5.md",
    device="robots.drivers.abb.new_abb_arm:new_abb_arm",
)
