"""What stands and lies in a cell: fixtures, parts, and bodies that nobody knows of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.cell_meshes import Decomposition, mesh_problems
from engine.document.cell_tools import ToolSpec, require_tools
from engine.document.placement import Angle, Color, FramedPlacement, Length, Offset
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError


class Jitter(StrictModel, frozen=True, kw_only=True):
    """Maximum random offset of a part in a seeded run, uniform in both directions."""

    xy_m: Offset = 0.0
    yaw_rad: Angle = 0.0


class Spring(StrictModel, frozen=True, kw_only=True):
    """Compliance of a fixture along its z axis: foam, a part on a compliant table, a sprung pad.

    Its surface is soft at first contact, which gives plausible forces while a tool slides over it;
    on a rigid fixture forces are plausible only at rest.
    """

    stiffness_n_m: Annotated[float, Meta(gt=0.0, description="Stiffness of the spring in N/m")]
    damping_ns_m: Annotated[float, Meta(ge=0.0, description="Damping of the spring in N s/m")] = 60.0
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass of the moving body in kilograms")] = 0.1
    friction: Annotated[float, Meta(ge=0.0, le=2.0, description="Coefficient of friction of the surface")] = 0.3


class Fixture(StrictModel, frozen=True, kw_only=True):
    """A fixed body, or a compliant one with a `spring`.

    `size_m` of a box: edge lengths x, y, z; of a cylinder: diameter, length; of a tray: its outer
    edge lengths, with `wall_m` for the thickness of walls and floor. `at` is the centre of a box
    or cylinder, the middle of the underside of a tray, and the origin of the file of a mesh. A mesh
    has the size of its `file`, an STL, OBJ or Collada file; `color` is that of files without colours.
    """

    shape: Literal["box", "cylinder", "tray", "mesh"]
    size_m: tuple[Length, ...] = ()
    wall_m: Length = 0.005
    file: Annotated[str, Meta(min_length=1, description="Mesh file, relative to this document")] | None = None
    scale: Annotated[float, Meta(gt=0.0, description="Metres for one unit of the mesh file: 0.001 for millimetres")] = (
        1.0
    )
    decomposition: Decomposition | None = None
    at: FramedPlacement = FramedPlacement()
    color: Color = "#b0b0b0"
    spring: Spring | None = None


class PartSpec(StrictModel, frozen=True, kw_only=True):
    """A free body with contact physics; `magnetic` if it is of iron or steel.

    `size_m` of a box: edge lengths x, y, z; of a cylinder: diameter, length; of a sphere: diameter.
    `at` is its centre. `friction` is that of its surface with any other body, where it is not that of rubber pads on
    dry steel or plastic: oil, wax, ice. A part with `tool` is the plate of a tool that a tool changer takes.
    """

    shape: Literal["box", "cylinder", "sphere"]
    size_m: tuple[Length, ...]
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass in kilograms, above 0")]
    magnetic: bool = False
    friction: (
        Annotated[float, Meta(gt=0.0, le=2.0, description="Coefficient of friction with any other body")] | None
    ) = None
    at: FramedPlacement = FramedPlacement()
    jitter: Jitter = Jitter()
    color: Color = "#d0d0d0"
    tool: Annotated[ToolSpec | None, Meta(description="What the tool consists of beside its plate")] = None


class UnknownBody(StrictModel, frozen=True, kw_only=True):
    """A body of the simulated world that nobody knows of: cameras see it, arms collide with it, and that is all.

    It is no obstacle of planners and no name in lists and checks. `size_m` as for a part; `at` is its centre. With
    `mass_kg` it is free, without it is fixed. For tests and demonstrations.
    """

    shape: Literal["box", "cylinder", "sphere"]
    size_m: tuple[Length, ...]
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass in kilograms, above 0")] | None = None
    at: FramedPlacement = FramedPlacement()
    color: Color = "#a04040"


_SIZES = {
    "box": "edge lengths x, y, z",
    "tray": "edge lengths x, y, z",
    "cylinder": "diameter, length",
    "sphere": "diameter",
}


def require_sizes(
    fixtures: Mapping[str, Fixture],
    parts: Mapping[str, PartSpec],
    source: DocumentSource,
    *,
    unknown_bodies: Mapping[str, UnknownBody] | None = None,
) -> None:
    """Require as many lengths as the shape of each body has, and that no part is named as a fixture.

    Raises:
        DocumentError: `where` is the position in the document.
    """
    bodies: list[tuple[DataPath, Fixture | PartSpec | UnknownBody]] = [
        *((("fixtures", name), fixture) for name, fixture in fixtures.items()),
        *((("parts", name), part) for name, part in parts.items()),
        *((("unknown_bodies", name), body) for name, body in (unknown_bodies or {}).items()),
    ]
    for path, body in bodies:
        if isinstance(body, Fixture):
            _require_mesh(body, source, path)
        if body.shape == "mesh":
            continue
        meaning = _SIZES[body.shape]
        due = len(meaning.split(","))
        if len(body.size_m) != due:
            lengths = "one length" if due == 1 else f"{due} lengths"
            raise DocumentError(
                f"the size of a {body.shape} has {lengths}, not {len(body.size_m)}",
                where=source.position((*path, "size_m")),
                hint=meaning,
            )
        if isinstance(body, Fixture) and body.shape == "tray" and body.spring is not None:
            raise DocumentError(
                "a tray cannot have a spring", where=source.position((*path, "spring")), hint="put a sprung box into it"
            )
    for name in parts:
        if name in fixtures:
            where = source.position(("parts", name), of_key=True)
            raise DocumentError(f"`{name}` is both a fixture and a part", where=where, hint="rename one")
    require_tools({name: (part.shape, part.tool) for name, part in parts.items()}, source)


def _require_mesh(fixture: Fixture, source: DocumentSource, path: DataPath) -> None:
    """Require what a mesh needs of a mesh, and nothing of it of other shapes."""
    for key, message, hint in mesh_problems(
        fixture.shape,
        file=fixture.file,
        scale=fixture.scale,
        decomposition=fixture.decomposition,
        other={"size_m": bool(fixture.size_m), "spring": fixture.spring is not None},
    ):
        raise DocumentError(message, where=source.position((*path, key)), hint=hint)
