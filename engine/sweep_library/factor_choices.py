"""What a sweep of a behavior can vary: its parameters, and the parts and values of its cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import cast

from engine.document import Behavior, Cell, ParameterSpec
from engine.sweep_library.sweep_view import FactorChoice

MOST_CHOICES = 1000
_PARAMETERS = {"number", "integer", "string", "boolean"}
_MOVES = {"x_m": "m", "y_m": "m", "z_m": "m", "yaw_rad": "rad"}
_UNITS = ("_m_s2", "_m_s", "_rad_s", "_hz", "_deg", "_rad", "_kg", "_m", "_s", "_n")


def factor_choices(behavior: Behavior, cell: Cell | None) -> list[FactorChoice]:
    """Return what can be varied, parameters first."""
    found = [_parameter(name, spec) for name, spec in behavior.parameters.items() if spec.type in _PARAMETERS]
    if cell is not None:
        parts = cell.document.parts
        found += [
            FactorChoice(address=f"displace.{part}.{move}", nominal=0.0, unit=unit, description="added to its pose")
            for part in parts
            for move, unit in _MOVES.items()
        ]
        found += _values(cell.source.data, "cell")
    return found[:MOST_CHOICES]


def _parameter(name: str, spec: ParameterSpec) -> FactorChoice:
    options = (False, True) if spec.type == "boolean" else spec.choices
    return FactorChoice(
        address=f"parameters.{name}",
        nominal=None if spec.required else spec.default,
        unit=spec.unit,
        description=spec.description,
        least=spec.minimum,
        most=spec.maximum,
        options=options,
    )


def _values(data: object, address: str) -> Iterator[FactorChoice]:
    """Yield the numbers that are written below an address."""
    items: Sequence[tuple[object, object]] = ()
    if isinstance(data, dict):
        items = list(cast("Mapping[object, object]", data).items())
    elif isinstance(data, list):
        items = list(enumerate(cast("list[object]", data)))
    for key, value in items:
        below = f"{address}.{key}"
        if isinstance(value, int | float) and not isinstance(value, bool):
            if below != "cell.flexcell":
                yield FactorChoice(address=below, nominal=value, unit=_unit(str(key)))
        else:
            yield from _values(value, below)


def _unit(key: str) -> str:
    """Return the unit in the name of a value."""
    suffix = next((each for each in _UNITS if key.endswith(each)), "")
    return {"_m_s": "m/s", "_m_s2": "m/s²", "_rad_s": "rad/s", "_hz": "Hz", "_n": "N"}.get(suffix, suffix[1:])
