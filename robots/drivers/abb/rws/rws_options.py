"""Where Robot Web Services are, and who asks there."""

from __future__ import annotations

import os
from typing import Annotated

from msgspec import Meta

from engine.document import StrictModel
from engine.errors import CellError

SignalName = Annotated[
    str,
    Meta(
        pattern=r"^\w+(/\w+/\w+)?$",
        max_length=120,
        description="Name of a digital signal at the controller, or network/device/name",
    ),
]
MOST_INPUTS = 16
"""Each is a request of its own, and the controller answers about twenty a second."""
_DOCUMENTED_PASSWORD = "robotics"  # noqa: S105  ABB documents it for the user that every controller has


class RwsOptions(StrictModel, frozen=True, kw_only=True):
    """Robot Web Services of the controller; its user needs the grants to switch motors on and to start programs.

    The password is the value of an environment variable, `${NAME}`; without one it is that of `Default User`.
    """

    host: Annotated[str, Meta(description="Address; empty for that of the driver")] = ""
    port: Annotated[int, Meta(ge=1, le=65535, description="TCP port")] = 80
    user: Annotated[str, Meta(min_length=1, max_length=80, description="User of the controller")] = "Default User"
    password: Annotated[str, Meta(pattern=r"^(\$\{\w+\})?$", description="${NAME} of an environment variable")] = ""
    timeout_s: Annotated[float, Meta(ge=0.1, le=10.0, description="Seconds until a reply counts as missing")] = 1.0
    stale_s: Annotated[
        float, Meta(ge=1.0, le=60.0, description="Seconds without an answer until the service counts as lost")
    ] = 3.0

    inputs: Annotated[
        tuple[SignalName, ...],
        Meta(max_length=MOST_INPUTS, description="Signals that are the digital inputs 0, 1, … of the arm"),
    ] = ()

    def __post_init__(self) -> None:
        """Refuse a signal that is named twice."""
        if len(set(self.inputs)) < len(self.inputs):
            twice = next(name for name in self.inputs if self.inputs.count(name) > 1)
            raise ValueError(f"`inputs` has {twice} twice")

    def secret(self, where: str) -> str:
        """Return the password.

        Raises:
            CellError: its environment variable is not set.
        """
        if not self.password:
            return _DOCUMENTED_PASSWORD
        name = self.password[2:-1]
        try:
            return os.environ[name]
        except KeyError:
            raise CellError(
                f"`password` of `rws` is {self.password}, and that environment variable is not set",
                where=where,
                hint=f"set {name} where the engine is started",
            ) from None
