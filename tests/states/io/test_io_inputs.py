"""The states that read inputs and wait for them."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from engine.skills.digital_inputs import DigitalInputs
from states.io.read_input import ReadInput
from states.io.wait_for_input import WaitForInput
from tests.states.fake_context import FakeContext

NAMES = {"door": 2}
CLOSED = DigitalInputs(values=(False, False, True), names=NAMES)
LOST = DigitalInputs(values=(), names=NAMES, problem="link cut: the controller closed the connection")
TOPIC = "arm/digital_inputs"


def chain(outcome: Any) -> list[str]:
    return [link.message for link in outcome.cause.chain()]


@pytest.mark.parametrize(
    ("given", "name", "outputs"),
    [
        ({"name": "door"}, "on", {"value": True}),
        ({"input": 2}, "on", {"value": True}),
        ({"input": 0}, "off", {"value": False}),
    ],
)
async def test_an_input_is_read_by_its_number_or_by_its_name_in_the_cell(
    given: dict[str, Any], name: str, outputs: dict[str, object]
) -> None:
    outcome = await ReadInput(robot="arm", **given).run(FakeContext(topics={TOPIC: CLOSED}))
    assert (outcome.name, outcome.outputs) == (name, outputs)


@pytest.mark.parametrize(
    ("message", "given", "reason"),
    [
        (LOST, {"name": "door"}, "link cut: the controller closed the connection"),
        (CLOSED, {"input": 3}, "there is no input 3; the inputs are 0 to 2"),
        (CLOSED, {"name": "gate"}, "there is no input gate; the cell names door"),
    ],
)
@pytest.mark.parametrize("kind", [ReadInput, WaitForInput])
async def test_an_input_that_is_not_known_is_an_outcome_with_the_reason(
    kind: type[ReadInput | WaitForInput], message: DigitalInputs, given: dict[str, Any], reason: str
) -> None:
    outcome = await kind(robot="arm", **given).run(FakeContext(topics={TOPIC: message}))
    assert outcome.name == "unknown"
    assert chain(outcome) == [f"{given.get('name', 'input 3')} of arm is not known", reason]


class ChangingContext(FakeContext):
    """Its topic has further messages after the first one."""

    def __init__(self, *messages: DigitalInputs) -> None:
        super().__init__(topics={TOPIC: messages[0]})
        self._messages = list(messages[1:])

    async def next_data(self, topic: str, condition: Any) -> object:
        while self._messages:
            self._topics[topic] = self._messages.pop(0)
            data = await self.latest_data(topic)
            if condition(data):
                return data
        return await asyncio.get_running_loop().create_future()


@pytest.mark.parametrize(
    ("value", "later", "outcome"),
    [(True, (), "reached"), (False, (CLOSED, DigitalInputs(values=(True, True, False))), "reached"),
     (False, (CLOSED, LOST), "unknown")],
)  # fmt: skip
async def test_a_wait_ends_with_the_value_or_once_nothing_is_known(
    value: bool, later: tuple[DigitalInputs, ...], outcome: str
) -> None:
    ended = await WaitForInput(robot="arm", input=2, value=value).run(ChangingContext(CLOSED, *later))
    assert ended.name == outcome


@pytest.mark.virtual
async def test_a_wait_that_takes_too_long_says_for_what() -> None:
    state = WaitForInput(robot="arm", name="door", value=False, timeout_s=2.0)
    outcome = await state.run(ChangingContext(CLOSED))
    assert (outcome.name, chain(outcome)) == ("timeout", ["door of arm was not off within 2 s"])


@pytest.mark.parametrize("given", [{}, {"input": 1, "name": "door"}])
@pytest.mark.parametrize("kind", [ReadInput, WaitForInput])
def test_an_input_has_one_name(kind: type[ReadInput | WaitForInput], given: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="either `input` or `name`"):
        kind(robot="arm", **given)
