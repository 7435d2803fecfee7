"""Entries that are pydantic models, recognized by their methods, so that the engine does not depend on pydantic."""

from __future__ import annotations

from typing import Any, Protocol, Self, TypeGuard, runtime_checkable


@runtime_checkable
class PydanticModel(Protocol):
    """An instance of a pydantic model, version 2."""

    @classmethod
    def model_validate(cls, obj: Any, /) -> Self:
        """Create a model from plain data; raises ValueError."""
        ...

    def model_dump(self, *, mode: str) -> dict[str, Any]:
        """Return the model as plain data."""
        ...


def is_model_type(kind: object) -> TypeGuard[type[PydanticModel]]:
    """Return whether `kind` is a class of pydantic models."""
    return isinstance(kind, type) and callable(getattr(kind, "model_validate", None)) and hasattr(kind, "model_dump")


def fields_of_model(kind: type[PydanticModel]) -> tuple[str, ...]:
    """Return the names of the fields of a model."""
    return tuple(getattr(kind, "model_fields", {}))


def first_fault(error: ValueError) -> str:
    """Return the first error, such as `size.rows: Input should be a valid integer`."""
    errors = getattr(error, "errors", None)
    if not callable(errors):
        return str(error)
    listed: Any = errors(include_url=False)
    first = listed[0]
    place = ".".join(str(part) for part in first["loc"])
    return f"{place}: {first['msg']}" if place else str(first["msg"])
