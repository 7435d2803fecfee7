"""The equipment files of ReconCycle's raspi_ros: read as they are, and converted to documents of ours."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal, cast

import msgspec
import yaml
from msgspec import Meta

from engine.document.equipment.equipment_document import (
    DigitalInputPin,
    DigitalOutputPin,
    EquipmentDocument,
    GpiozeroPins,
    Pin,
    PinName,
)
from engine.document.placement import Name
from engine.document.text.decoding import StrictModel, combine_mistakes, decode_document
from engine.document.text.yaml_source import DocumentSource
from engine.document.text.yaml_writer import write_yaml
from engine.errors import DocumentError, Position

# PyYAML has no types of its own for these two.
_compose = cast("Any", yaml).compose
_scalar = cast("Any", yaml.SafeLoader("")).construct_object
_PYTHON = re.compile(r"^(?:[^#\n'\"]*[\s:\-\[{,])?!!?(?:<tag:yaml\.org,2002:)?python/", re.MULTILINE)
_PWM = "the pulses of a ReconCycle PWM (an angle over its `signal_to_angle`) are not offered"
_PWM_HINT = "set `actual_config: empty`, or write a document of flexcell with `kind: pwm`, which sets a duty"


class ReconcyclePin(StrictModel, frozen=True, kw_only=True):
    """One entry of `pin_configs`."""

    actual_config: Literal["empty", "DigitalInput", "DigitalOutput", "PWM"]
    available_config: tuple[str, ...] = ()
    config_name: str = ""
    config_parameters: str | int | float | list[str | int | float] | None = ""
    pin_number: Annotated[int, Meta(ge=0, le=53)]
    service_name: str = ""


class ReconcycleFile(StrictModel, frozen=True, kw_only=True):
    """A configuration of raspi_ros."""

    config_name: str
    hardware_type: str
    pin_configs: tuple[ReconcyclePin, ...]


def is_reconcycle(data: object) -> bool:
    """Return whether the data of a document is such a configuration."""
    return isinstance(data, dict) and "pin_configs" in data


def refuse_python_objects(text: str, *, file: str) -> None:
    """Refuse a file that asks for Python objects; raises DocumentError with the line."""
    found = _PYTHON.search(text)
    if found is not None:
        start = text.index("!", found.start())
        line = text.count("\n", 0, start) + 1
        column = start - (text.rfind("\n", 0, start) + 1) + 1
        raise DocumentError(
            "the file asks to make Python objects, which is never done",
            where=Position(file=file, line=line, column=column),
            hint=f"flexcell equipment convert {file}",
        )


def read_reconcycle(source: DocumentSource, *, name: str) -> EquipmentDocument:
    """Return a configuration as a document: pins of this computer by lgpio, all safe values off.

    Raises:
        DocumentError: an entry is invalid or cannot be served; `where` is its position.
    """
    file = decode_document(source, ReconcycleFile)
    pins: dict[str, Pin] = {}
    mistakes: list[DocumentError] = []
    numbers: dict[int, str] = {}

    def refuse(index: int, key: str, message: str, hint: str) -> None:
        where = source.position(("pin_configs", index, key))
        mistakes.append(DocumentError(message, where=where, hint=hint))

    for index, entry in enumerate(file.pin_configs):
        if entry.actual_config == "empty":
            continue
        service = entry.service_name.lstrip("/").replace("/", "_")
        if entry.actual_config == "PWM":
            refuse(index, "actual_config", f"pin {entry.pin_number}: {_PWM}", _PWM_HINT)
        elif not _is(PinName, service):
            hint = "letters, digits and `_`, such as `clamp_open`"
            refuse(index, "service_name", f"pin {entry.pin_number}: `{entry.service_name}` is no name", hint)
        elif service in pins:
            refuse(index, "service_name", f"two pins have the name `{service}`", "each service has one pin")
        elif entry.pin_number in numbers:
            message = f"pin {entry.pin_number} of `{service}` is that of `{numbers[entry.pin_number]}`"
            refuse(index, "pin_number", message, "each pin has one name")
        elif entry.actual_config == "DigitalOutput":
            pins[service] = DigitalOutputPin(pin=entry.pin_number, safe=False)
        else:
            pins[service] = DigitalInputPin(pin=entry.pin_number)
        numbers.setdefault(entry.pin_number, service)
    if not pins and not mistakes:
        hint = "set `actual_config` and `service_name` of a pin"
        mistakes.append(DocumentError("all pins are empty", where=source.position(("pin_configs",)), hint=hint))
    if mistakes:
        raise combine_mistakes(mistakes)
    title = file.config_name if _is(Name, file.config_name) and file.config_name != "empty" else name
    title = title if _is(Name, title) else "equipment"
    return EquipmentDocument(flexcell=1, equipment=title, backend=GpiozeroPins(factory="lgpio"), pins=pins)


def plain_reconcycle(text: str, *, file: str) -> str:
    """Return a configuration without its Python objects, of which only mappings with the keys of a pin are known.

    Nothing is constructed: only the nodes of the text are read.

    Raises:
        DocumentError: it is no YAML, or an object is written in another manner; `where` is the position.
    """
    try:
        root: yaml.Node | None = _compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        raise DocumentError(
            f"no valid YAML: {error}".splitlines()[0], where=Position(file=file, line=1, column=1)
        ) from error
    if root is None:
        raise DocumentError("the file is empty", where=Position(file=file, line=1, column=1))
    return write_yaml(_plain(root, file))


def document_text(document: EquipmentDocument) -> str:
    """Return an equipment document as text, safe values always written."""
    data: dict[str, Any] = msgspec.to_builtins(document)
    return write_yaml(data)


def _is(kind: object, text: str) -> bool:
    try:
        msgspec.convert(text, kind)
    except msgspec.ValidationError:
        return False
    return True


def _plain(node: yaml.Node, file: str) -> object:
    if isinstance(node, yaml.MappingNode):
        pairs = cast("list[tuple[yaml.Node, yaml.Node]]", node.value)
        data = {str(key.value): _plain(value, file) for key, value in pairs}
        if not node.tag.startswith("tag:yaml.org,2002:python/"):
            return data
        state = data.get("state", data.get("dictitems", data))
        if isinstance(state, Mapping):
            return cast("Mapping[str, object]", state)
        raise _unreadable(node, file)
    if node.tag.startswith("tag:yaml.org,2002:python/") and not node.tag.startswith("tag:yaml.org,2002:python/tuple"):
        raise _unreadable(node, file)
    if isinstance(node, yaml.SequenceNode):
        return [_plain(item, file) for item in cast("list[yaml.Node]", node.value)]
    return _scalar(node)


def _unreadable(node: yaml.Node, file: str) -> DocumentError:
    mark = node.start_mark
    return DocumentError(
        "this Python object holds a list of values without names, whose order only its class knows",
        where=Position(file=file, line=mark.line + 1, column=mark.column + 1),
        hint="write the pin as a mapping with actual_config, pin_number and service_name",
    )
