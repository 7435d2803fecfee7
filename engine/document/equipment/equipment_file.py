"""Reads equipment documents, checks what their back ends cannot do, and takes the files of ReconCycle as they are."""

from __future__ import annotations

from pathlib import Path

from engine.document.equipment.equipment_document import (
    MOST_GPIO,
    DigitalInputPin,
    EquipmentDocument,
    GpiozeroPins,
    ModbusPins,
    PwmPin,
)
from engine.document.equipment.reconcycle_file import is_reconcycle, read_reconcycle, refuse_python_objects
from engine.document.text.decoding import combine_mistakes, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import DataPath, DocumentSource, load_text, parse_source
from engine.errors import DocumentError


class Equipment(DocumentFile[EquipmentDocument]):
    """An equipment document with its file."""


def load_equipment(file: Path) -> Equipment:
    """Read an equipment document, or a file of ReconCycle's raspi_ros as it is.

    Raises:
        DocumentError: the file cannot be read or is not valid; `where` is the position, `others` are other mistakes.
    """
    return read_equipment(load_text(file), file=file)


def read_equipment(content: bytes | str, *, file: Path) -> Equipment:
    """Read the text of an equipment document, which is or will be in `file`; raises as `load_equipment`."""
    text = content.decode("utf-8", errors="replace") if isinstance(content, bytes) else content
    refuse_python_objects(text, file=str(file))
    source = parse_source(content, file=str(file))
    if is_reconcycle(source.data):
        return Equipment(document=read_reconcycle(source, name=file.stem), file=file, source=source)
    document = decode_document(source, EquipmentDocument)
    mistakes = _mistakes(document, source)
    if mistakes:
        raise combine_mistakes(mistakes)
    return Equipment(document=document, file=file, source=source)


def _mistakes(document: EquipmentDocument, source: DocumentSource) -> list[DocumentError]:
    """Return what the back end cannot do, and pins that are named twice."""
    found: list[DocumentError] = []
    taken: dict[tuple[str, int], str] = {}

    def refuse(path: DataPath, message: str, hint: str) -> None:
        found.append(DocumentError(message, where=source.position(path), hint=hint))

    gpio = isinstance(document.backend, GpiozeroPins)
    for name, pin in document.pins.items():
        path: DataPath = ("pins", name, "pin")
        is_input = isinstance(pin, DigitalInputPin)
        # Coils and discrete inputs of a PLC count apart.
        space = "input" if is_input and not gpio else "output"
        other = taken.setdefault((space, pin.pin), name)
        if other != name:
            refuse(path, f"pin {pin.pin} of `{name}` is that of `{other}`", "each pin has one name")
        if gpio and pin.pin > MOST_GPIO:
            refuse(path, f"there is no GPIO {pin.pin}", f"use BCM numbers from 0 to {MOST_GPIO}")
        if isinstance(document.backend, ModbusPins):
            if isinstance(pin, PwmPin):
                refuse(("pins", name, "kind"), "a PLC over Modbus offers no PWM", "use coils and discrete inputs")
            if is_input and pin.pull != "none":
                refuse(("pins", name, "pull"), "a PLC has its own resistors", "remove `pull`")
    return found
