"""Model folders: reads and checks `robot.yaml` or `tool.yaml`, locates the URDF and removes unused links."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Generic, TypeVar, Union, cast

import msgspec

from engine.document import DataPath, DocumentSource, decode_document, load_source
from engine.errors import CellError, DocumentError
from engine.wording import did_you_mean
from robots.model.folder.folder_document import (
    CollisionPairs,
    FileReference,
    RobotDocument,
    ToolDocument,
    UrdfSource,
)
from robots.model.urdf.description import disabled_collisions, installed_share_dir
from robots.model.urdf.urdf_tree import (
    Element,
    descendants_of,
    joints_of,
    keep_links,
    links_of,
    read_urdf,
    root_of,
    take_collisions,
)
from robots.tool_kinds import load_mechanisms

Document = TypeVar("Document", RobotDocument, ToolDocument)

_OWN = Path(__file__).resolve().parents[2]

ROBOT_FILE, TOOL_FILE = "robot.yaml", "tool.yaml"


@dataclass(frozen=True, kw_only=True)
class ModelFolder(Generic[Document]):
    """A model folder with its document."""

    folder: Path
    document: Document
    source: DocumentSource = field(repr=False)

    def locate(self, file: FileReference) -> Path:
        """Return the path of a file named in the document.

        Raises:
            CellError: its package is not installed, or it is outside the folder or the package.
        """
        home = self.folder if file.package is None else installed_share_dir(package=file.package, marker=file.file)
        path = home / file.file
        if not self._may_use(path, home):
            raise CellError(
                f"{file.file:.200} is outside the model folder", where=str(self.folder), hint="move it into the folder"
            )
        return path

    @staticmethod
    def _may_use(path: Path, home: Path) -> bool:
        # Built-in models share a licence next to their folders.
        return any(path.resolve().is_relative_to(place) for place in (home.resolve(), _OWN))

    def package_dir(self, file: FileReference) -> Path:
        """Return the folder that contains the meshes of a description."""
        if file.package is None:
            return self.folder.parent
        return installed_share_dir(package=file.package, marker=file.file)

    def urdf(self) -> Element:
        """Return a new tree of the document's URDF, without removed links, with the selected collision shapes.

        Raises:
            CellError: it cannot be read or a mesh is missing.
            DocumentError: the root or a link to remove does not exist.
        """
        urdf: UrdfSource = self.document.urdf
        directory = self.package_dir(urdf)
        within = self.folder if urdf.package is None else directory
        robot = read_urdf(self.locate(urdf), package_dir=directory, within=within)
        root = self._known(urdf.root, links_of(robot), ("urdf", "root"), "link") if urdf.root else root_of(robot)
        kept = descendants_of(robot, root)
        for index, link in enumerate(urdf.without):
            kept -= descendants_of(robot, self._known(link, links_of(robot), ("urdf", "without", index), "link"))
        keep_links(robot, kept)
        if urdf.collision_file is not None:
            other = self.locate(FileReference(file=urdf.collision_file, package=urdf.package))
            take_collisions(robot, read_urdf(other, package_dir=directory, within=within))
        return robot

    def allowed_collisions(self) -> tuple[tuple[str, str], ...]:
        """Return the pairs of the SRDF, then those of the document."""
        collisions: CollisionPairs = self.document.collisions
        listed = disabled_collisions(self.locate(collisions.srdf)) if collisions.srdf is not None else ()
        return (*listed, *collisions.allowed)

    def _known(self, name: str, known: dict[str, Element], path: DataPath, what: str) -> str:
        if name not in known:
            raise DocumentError(
                f"the URDF has no {what} {name}", where=self.source.position(path), hint=did_you_mean(name, known)
            )
        return name

    def require_joints(self, robot: Element, named: list[tuple[DataPath, str]]) -> None:
        """Raise DocumentError at the first name that is not a joint of `robot`."""
        for path, name in named:
            self._known(name, joints_of(robot), path, "joint")

    def require_links(self, robot: Element, named: list[tuple[DataPath, str]]) -> None:
        """Raise DocumentError at the first name that is not a link of `robot`."""
        for path, name in named:
            self._known(name, links_of(robot), path, "link")


def load_arm(folder: Path) -> ModelFolder[RobotDocument]:
    """Read the `robot.yaml` of a folder; raises DocumentError with its position if it is invalid."""
    source = _read(folder, ROBOT_FILE)
    arm = ModelFolder(folder=folder, document=decode_document(source, RobotDocument), source=source)
    names = [joint.name for joint in arm.document.joints]
    for index, joint in enumerate(arm.document.joints):
        if not joint.lower_rad <= joint.home_rad <= joint.upper_rad:
            where = source.position(("joints", index, "home_rad"))
            raise DocumentError(f"home of {joint.name} is outside its limits", where=where)
    for index, device in enumerate(arm.document.device_joints):
        for name in (device.joint, *device.plus):
            if name not in names:
                where = source.position(("device_joints", index))
                raise DocumentError(f"there is no joint {name}", where=where, hint=did_you_mean(name, names))
    return arm


def load_tool(folder: Path) -> ModelFolder[ToolDocument]:
    """Read the `tool.yaml` of a folder; raises DocumentError with its position if it is invalid."""
    source = _read(folder, TOOL_FILE)
    return ModelFolder(
        folder=folder, document=decode_document(source, _tool_document(load_mechanisms())), source=source
    )


def _read(folder: Path, name: str) -> DocumentSource:
    if not (folder / name).is_file():
        other = TOOL_FILE if name == ROBOT_FILE else ROBOT_FILE
        hint = (
            f"the folder is another kind of model: it has a {other}"
            if (folder / other).is_file()
            else "see docs/how-to/add-a-robot.md"
        )
        raise CellError(f"there is no {name} in {folder}", where=folder.name, hint=hint)
    return load_source(folder / name)


@cache
def _tool_document(mechanisms: tuple[object, ...]) -> type[ToolDocument]:
    """Return the model of `tool.yaml` with the mechanisms that it may have."""
    union: Any = Union[mechanisms]  # noqa: UP007 - known at run time only
    made = msgspec.defstruct(
        ToolDocument.__name__, [("mechanism", union)], bases=(ToolDocument,), frozen=True, kw_only=True
    )
    return cast("type[ToolDocument]", made)
