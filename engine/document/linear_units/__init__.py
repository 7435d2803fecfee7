"""Linear units of a cell: how they are written, and what a document may say of them."""

from engine.document.linear_units.linear_unit_spec import LinearScale, LinearUnitSpec

__all__ = ["LinearScale", "LinearUnitSpec"]
