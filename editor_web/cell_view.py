"""The 3D view of the cell: the only module that knows viser.

viser runs its own thread and port; it is bound to loopback and locked with a secret header that
only our proxy sends (`routes/cell.py`), because by itself it asks nobody for a password. Meshes
are sent once; afterwards only the poses of frames that moved are written, at most 30 times a second.
"""

from __future__ import annotations

import hmac
import http
import io
import logging
import secrets
import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import viser
import websockets.asyncio.server
from numpy.typing import NDArray

from editor_web.backend import Backend, Unsubscribe
from engine.errors import FlexcellError
from engine.messages import FramePoses, Quaternion, SceneDescription, Vector3, VisualGeometry

KEY_HEADER = "X-Cell-Key"
PERIOD_S = 1.0 / 30.0
_log = logging.getLogger("flexcell.cell_view")
_VIEW_DIRECTION = np.array([0.42, -0.8, 0.5])
_HIDE_PANEL = (
    b"<style>[data-testid=floating-panel],[data-floating-window],[data-dock-region],div:has([data-dock-root])~.mantine-Paper-root,"
    b".mantine-Notifications-root{display:none!important}</style></head>"
)


def page() -> bytes:
    """Return viser's one-file page with its own panel hidden."""
    built = Path(viser.__file__).parent / "client" / "build" / "index.html"
    return built.read_bytes().replace(b"</head>", _HIDE_PANEL, 1)


@dataclass(frozen=True, kw_only=True)
class _Pose:
    xyz: Vector3
    xyzw: Quaternion

    @property
    def wxyz(self) -> tuple[float, float, float, float]:
        x, y, z, w = self.xyzw
        return (w, x, y, z)


class CellView:
    """Draws `cell/scene` and `cell/frames` of the backend's bus.

    Args:
        backend: Where the two topics are.
        shadows: Whether lights cast shadows; slow without a graphics card.
    """

    def __init__(self, backend: Backend, *, shadows: bool = True) -> None:
        self._backend = backend
        self._shadows = shadows
        self.key = secrets.token_urlsafe(32)
        self._server: viser.ViserServer | None = None
        self._thread: threading.Thread | None = None
        self._subscriptions: list[Unsubscribe] = []
        self._wake = threading.Event()
        self._ending = threading.Event()
        # Written by the loop's thread, read by the writer: one reference each, the newest wins.
        self._scene: SceneDescription | None = None
        self._poses: FramePoses | None = None

    @property
    def port(self) -> int:
        """viser's loopback port; the view must be open."""
        if self._server is None:
            raise FlexcellError("the cell view is not open", hint="open it first")
        return self._server.get_port()

    def open(self) -> None:
        """Start viser and the writer thread; takes some 20 ms, call it off the event loop."""
        # viser greets on stdout, which belongs to the command line's own output.
        with _locked(self.key), redirect_stdout(io.StringIO()):
            # 127.0.0.1 can always be bound; viser would wait for ever on an address that cannot.
            self._server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        # Any connected page may ask viser to publish itself through a public tunnel: never.
        self._server.request_share_url = _no_tunnel
        self._server.gui.configure_theme(show_logo=False, show_share_button=False)
        self._server.scene.set_up_direction("+z")
        self._server.scene.configure_default_lights(cast_shadow=self._shadows)
        self._thread = threading.Thread(target=self._write, name="cell-view", daemon=True)
        self._thread.start()

    def request_tunnel(self) -> str | None:
        """Return what viser answers to a page that asks to be published: always None."""
        return self._server.request_share_url() if self._server else None

    def subscribe(self) -> None:
        """Follow the two topics as far as the cell has them; call it on the event loop's thread."""
        topics = {"cell/scene": self._on_scene, "cell/frames": self._on_frames}
        for topic, callback in topics.items():
            try:
                self._subscriptions.append(self._backend.subscribe_topic(topic, callback))
            except FlexcellError as error:
                _log.info("nothing to draw from %s: %s", topic, error)

    def unsubscribe(self) -> None:
        """Stop following; call it on the event loop's thread."""
        for unsubscribe in self._subscriptions:
            unsubscribe()
        self._subscriptions = []

    def close(self) -> None:
        """End the threads; may take a second, call it off the event loop."""
        self._ending.set()
        self._wake.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        if self._server is not None:
            with redirect_stdout(io.StringIO()):
                self._server.stop()
            self._server = None

    def _on_scene(self, message: object) -> None:
        if isinstance(message, SceneDescription):
            self._scene = message
            self._wake.set()

    def _on_frames(self, message: object) -> None:
        if isinstance(message, FramePoses):
            self._poses = message
            self._wake.set()

    def _write(self) -> None:
        server = self._server
        if server is None:
            return
        drawing: _Drawing | None = None
        while not self._ending.is_set():
            self._wake.wait()
            self._wake.clear()
            scene, poses = self._scene, self._poses
            if scene is not None and (drawing is None or drawing.scene is not scene):
                drawing = _Drawing(server, scene, poses)
            if drawing is not None and poses is not None:
                drawing.move(poses)
            self._ending.wait(PERIOD_S)


class _Drawing:
    """One scene in viser: a frame per moving body with its geometries below."""

    def __init__(self, server: viser.ViserServer, scene: SceneDescription, poses: FramePoses | None) -> None:
        self.scene = scene
        self._server = server
        self._drawn: dict[str, _Pose] = {}
        known = _by_name(poses) if poses else {}
        with server.atomic():
            server.scene.reset()
            server.scene.add_grid(
                "/floor",
                infinite_grid=True,
                cell_size=0.1,
                section_size=1.0,
                position=(0.0, 0.0, _lowest(scene, known)),
            )
            self._frames = {name: self._add_frame(name) for name in sorted({g.frame for g in scene.geometries})}
            for index, geometry in enumerate(scene.geometries):
                try:
                    _add_geometry(server, f"{_node(geometry.frame)}/{index}", geometry)
                except (FlexcellError, ValueError) as error:
                    # One shape that cannot be drawn must not hide the rest of the cell.
                    _log.warning("%s is not drawn: %s", geometry.name, error)
            self._look(known)
        if poses:
            self.move(poses)

    def move(self, poses: FramePoses) -> None:
        """Write the frames whose pose changed, all in one message."""
        moved = [
            (name, pose)
            for name, pose in _by_name(poses).items()
            if name in self._frames and self._drawn.get(name) != pose
        ]
        if not moved:
            return
        with self._server.atomic():
            for name, pose in moved:
                handle = self._frames[name]
                before = self._drawn.get(name)
                if before is None or before.xyz != pose.xyz:
                    handle.position = pose.xyz
                if before is None or before.xyzw != pose.xyzw:
                    handle.wxyz = pose.wxyz
                self._drawn[name] = pose

    def _add_frame(self, name: str) -> viser.FrameHandle:
        return self._server.scene.add_frame(_node(name), show_axes=False)

    def _look(self, known: dict[str, _Pose]) -> None:
        corners = [_corners(g, known.get(g.frame)) for g in self.scene.geometries]
        if not corners:
            return
        points = np.concatenate(corners)
        low, high = points.min(axis=0), points.max(axis=0)
        centre = (low + high) / 2
        fov_rad = np.radians(45.0)
        distance_m = float(np.linalg.norm(high - low)) / 2 / np.tan(fov_rad / 2) * 0.95
        camera = self._server.initial_camera
        camera.fov = float(fov_rad)
        camera.look_at = centre
        camera.position = centre + _VIEW_DIRECTION / np.linalg.norm(_VIEW_DIRECTION) * distance_m


def _node(frame: str) -> str:
    # A slash would nest the frame below another one, and poses are all in the world.
    return f"/cell/{frame.replace('/', '.')}"


def _by_name(poses: FramePoses) -> dict[str, _Pose]:
    return {name: _Pose(xyz=xyz, xyzw=xyzw) for name, xyz, xyzw in zip(poses.names, poses.xyz, poses.xyzw, strict=True)}


def _vertices(geometry: VisualGeometry) -> NDArray[np.float32]:
    return np.frombuffer(geometry.vertices, dtype=np.float32).reshape(-1, 3)


def _add_geometry(server: viser.ViserServer, name: str, geometry: VisualGeometry) -> None:
    red, green, blue, alpha = geometry.rgba
    x, y, z, w = geometry.xyzw
    # The options are the same for each kind of shape; viser types them separately.
    common: dict[str, Any] = {
        "color": (round(red * 255), round(green * 255), round(blue * 255)),
        "opacity": None if alpha >= 1.0 else alpha,
        "cast_shadow": True,
        "wxyz": (w, x, y, z),
        "position": geometry.xyz,
    }
    match geometry.kind:
        case "box":
            server.scene.add_box(
                name, dimensions=(geometry.size_m[0], geometry.size_m[1], geometry.size_m[2]), **common
            )
        case "cylinder":
            server.scene.add_cylinder(name, radius=geometry.size_m[0], height=geometry.size_m[1], **common)
        case "sphere":
            server.scene.add_icosphere(name, radius=geometry.size_m[0], **common)
        case "mesh":
            faces = np.frombuffer(geometry.faces, dtype=np.uint32).reshape(-1, 3)
            server.scene.add_mesh_simple(name, vertices=_vertices(geometry), faces=faces, **common)
        case _:
            raise FlexcellError(
                f"the scene has a geometry of unknown kind {geometry.kind!r}",
                where=geometry.name,
                hint="use box, cylinder, sphere or mesh",
            )


def _corners(geometry: VisualGeometry, pose: _Pose | None) -> NDArray[np.float64]:
    """Return the eight corners (8 x 3, world, metres) of a geometry's box."""
    if geometry.kind == "mesh":
        local = _vertices(geometry).astype(np.float64)
        if local.size == 0:
            return np.zeros((0, 3))
        low, high = local.min(axis=0), local.max(axis=0)
    else:
        half = np.asarray(_half_size(geometry), dtype=np.float64)
        low, high = -half, half
    grid = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    inside = grid @ _rotation(geometry.xyzw).T + np.asarray(geometry.xyz)
    if pose is None:
        return inside
    return inside @ _rotation(pose.xyzw).T + np.asarray(pose.xyz)


def _half_size(geometry: VisualGeometry) -> Vector3:
    size = geometry.size_m
    if geometry.kind == "box":
        return (size[0] / 2, size[1] / 2, size[2] / 2)
    if geometry.kind == "cylinder":
        return (size[0], size[0], size[1] / 2)
    return (size[0], size[0], size[0])


def _rotation(xyzw: Quaternion) -> NDArray[np.float64]:
    x, y, z, w = xyzw
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _lowest(scene: SceneDescription, known: dict[str, _Pose]) -> float:
    heights = [float(c[:, 2].min()) for g in scene.geometries if len(c := _corners(g, known.get(g.frame)))]
    return min(heights, default=0.0)


def _no_tunnel(verbose: bool = True) -> str | None:
    del verbose
    return None


@contextmanager
def _locked(key: str) -> Generator[None]:
    """Make the server that viser opens inside demand our header; viser has no option for it."""
    original: Callable[..., Any] = websockets.asyncio.server.serve

    def serve(*args: Any, **options: Any) -> Any:
        inner: Callable[..., Any] | None = options.get("process_request")

        def checked(connection: Any, request: Any) -> Any:
            given = request.headers.get(KEY_HEADER, "")
            if not hmac.compare_digest(given.encode(), key.encode()):
                return connection.respond(http.HTTPStatus.FORBIDDEN, "open the cell view through the dashboard\n")
            return inner(connection, request) if inner else None

        return original(*args, **{**options, "process_request": checked})

    websockets.asyncio.server.serve = serve  # pyright: ignore[reportAttributeAccessIssue] # viser looks it up there
    try:
        yield
    finally:
        websockets.asyncio.server.serve = original  # pyright: ignore[reportAttributeAccessIssue] # as above
