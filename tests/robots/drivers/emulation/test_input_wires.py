"""What a plant senses comes to the inputs of its controller, and a side channel may say otherwise in between."""

from __future__ import annotations

from robots.drivers.emulation.input_wires import InputWires


def test_each_change_is_passed_on_once() -> None:
    sensed, heard = {2: False}, list[tuple[int, bool]]()

    def hear(number: int, *, on: bool) -> None:
        heard.append((number, on))

    wires = InputWires(lambda: sensed, hear)
    wires.follow()
    wires.follow()
    sensed[2] = True
    wires.follow()
    # Somebody else sets it meanwhile: it stays so until the next change.
    wires.follow()
    sensed[2] = False
    wires.follow()
    assert heard == [(2, False), (2, True), (2, False)]
