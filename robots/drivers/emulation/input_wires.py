"""The wires from what a plant senses to the digital inputs of its emulated controller."""

from __future__ import annotations

from typing import Protocol

from robots.drivers.emulation.plant import PlantInputs


class InputSetter(Protocol):
    """The terminals of the digital inputs of a controller."""

    def __call__(self, number: int, *, on: bool) -> None:
        """Turn an input on or off."""
        ...


class InputWires:
    """Passes each change on; in between a side channel may set an input, as a broken sensor does.

    Args:
        sensed: Returns the inputs that something is connected to, by number.
        set_input: Sets an input of the controller.
    """

    def __init__(self, sensed: PlantInputs, set_input: InputSetter) -> None:
        self._sensed = sensed
        self._set_input = set_input
        self._last: dict[int, bool] = {}

    def follow(self) -> None:
        """Pass on what has changed; call it in each cycle of the controller."""
        for number, on in self._sensed().items():
            if self._last.get(number) != on:
                self._last[number] = on
                self._set_input(number, on=on)
