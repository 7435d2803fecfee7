"""Equipment of a cell document: its driver, and the document of its pins."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.equipment.equipment_file import Equipment, load_equipment
from engine.document.placement import Name
from engine.document.robot_spec import require_driver_kind
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DocumentSource
from engine.errors import DocumentError


class EquipmentSpec(StrictModel, frozen=True, kw_only=True):
    """Outputs and inputs under names, of a computer or PLC at a module.

    `driver` is `sim`, pins in memory, or a mapping with the driver's name as `kind` and its options as further keys.
    `pins` is the equipment document, which a check and a simulation need.
    """

    driver: Literal["sim"] | dict[str, object] = "sim"
    pins: Annotated[str, Meta(min_length=1, description="Equipment document, relative to this one")] | None = None

    @property
    def simulated(self) -> bool:
        """Whether its pins are in memory."""
        return self.driver == "sim"

    @property
    def driver_kind(self) -> str:
        """The name of the driver; its options are the other keys of `driver`."""
        return self.driver if isinstance(self.driver, str) else str(self.driver["kind"])


def load_pins(
    equipment: Mapping[Name, EquipmentSpec], source: DocumentSource, *, folder: Path, taken: Mapping[str, str]
) -> dict[str, Equipment]:
    """Return the equipment documents of a cell document in `folder`, by the names of the equipment in the cell.

    Args:
        equipment: The section.
        source: The cell document.
        folder: What its paths are relative to.
        taken: What has each name already.

    Raises:
        DocumentError: a name is taken, a driver has no kind, or an equipment document is missing or not valid.
    """
    found: dict[str, Equipment] = {}
    for name, spec in equipment.items():
        if name in taken:
            where = source.position(("equipment", name), of_key=True)
            raise DocumentError(f"`{name}` is both equipment and a {taken[name]}", where=where, hint="rename one")
        require_driver_kind(f"equipment `{name}`", spec.driver, source, ("equipment", name, "driver"))
        if spec.pins is None:
            if spec.simulated:
                hint = "add `pins: FILE`, the equipment document that the real server has"
                where = source.position(("equipment", name), of_key=True)
                raise DocumentError(
                    f"equipment `{name}` is simulated, but nothing names its pins", where=where, hint=hint
                )
            continue
        file = (folder / spec.pins).resolve()
        if not file.is_file():
            where = source.position(("equipment", name, "pins"))
            raise DocumentError(
                f"there is no file {spec.pins}", where=where, hint="it is relative to the cell document"
            )
        found[name] = load_equipment(file)
    return found
