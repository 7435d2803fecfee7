"""Equipment documents and the files of ReconCycle: what is read, and what is refused with its position."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.equipment.equipment_document import DigitalOutputPin
from engine.document.equipment.equipment_file import read_equipment
from engine.document.equipment.reconcycle_file import document_text, plain_reconcycle
from engine.errors import DocumentError

HEAD = "flexcell: 1\nequipment: clamps\nbackend: {kind: gpiozero, factory: mock}\npins:\n"
RECONCYCLE = """\
config_name: empty
hardware_type: raspberry 4
pin_configs:
- actual_config: DigitalOutput
  available_config: [DigitalInput, DigitalOutput, empty]
  config_name: ''
  config_parameters: ''
  pin_number: 1
  service_name: /obr_block2_ON
"""
OBJECT = """\
- !!python/object/new:digital_interface_msgs.msg._OnePinConfig.OnePinConfig
  state: {actual_config: DigitalInput, pin_number: 3, service_name: there}
"""
FILE = Path("e.yaml")


@pytest.mark.parametrize(
    ("pins", "words"),
    [
        ("  a: {kind: digital_output, pin: 1}\n", r"e\.yaml:5:\d+: .*safe"),
        ("  a: {kind: digital_input, pin: 1}\n  b: {kind: digital_input, pin: 1}\n", r"e\.yaml:6:\d+: pin 1 of `b`"),
        ("  a: {kind: digital_input, pin: 54}\n", r"e\.yaml:5:\d+: there is no GPIO 54"),
    ],
)
def test_mistakes_have_their_position(pins: str, words: str) -> None:
    """File, line and column."""
    with pytest.raises(DocumentError, match=words):
        read_equipment(HEAD + pins, file=FILE)


def test_a_file_of_reconcycle_is_read_as_it_is() -> None:
    """By the name of its service, off when safe."""
    document = read_equipment(RECONCYCLE, file=FILE).document
    assert document.pins == {"obr_block2_ON": DigitalOutputPin(pin=1, safe=False)}


def test_python_objects_are_refused_and_converted() -> None:
    """The refusal names the command that reads the nodes; what it prints is a document."""
    with pytest.raises(DocumentError, match=r"e\.yaml:10:3: .*flexcell equipment convert"):
        read_equipment(RECONCYCLE + OBJECT, file=FILE)
    document = read_equipment(plain_reconcycle(RECONCYCLE + OBJECT, file="e.yaml"), file=FILE).document
    assert list(document.pins) == ["obr_block2_ON", "there"]
    assert read_equipment(document_text(document), file=FILE).document == document


def test_pulses_are_refused() -> None:
    """A duty is something else."""
    with pytest.raises(DocumentError, match=r"e\.yaml:4:\d+: pin 1: the pulses of a ReconCycle PWM"):
        read_equipment(RECONCYCLE.replace("DigitalOutput\n", "PWM\n", 1), file=FILE)


@given(content=st.one_of(st.binary(max_size=200), st.text(max_size=200).map(lambda text: (HEAD + text).encode())))
def test_any_bytes_are_a_document_or_an_error_of_one(content: bytes) -> None:
    """Nothing else is raised."""
    with suppress(DocumentError):
        read_equipment(content, file=FILE)
