"""The reach of an arm as a table by height, as a coloured point cloud (PLY), and as JSON."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import msgspec

from engine.cell.reach_map import ReachLevel, ReachPoint


def reach_table(level: ReachLevel) -> Iterator[str]:
    """Yield a line for each height, from the lowest, and one for all of them."""
    layers: defaultdict[float, list[ReachPoint]] = defaultdict(list)
    for point in level.points:
        layers[point.xyz[2]].append(point)
    yield f"{'z in m':>8} {'points':>7} {'x in m':>16} {'y in m':>16} {'directions':>11} {'manipulability':>15}"
    for z in sorted(layers):
        yield f"{z:>8.3f} {_line(layers[z])}"
    if level.points:
        yield f"{'all':>8} {_line(level.points)}"
    grid = f"{level.searched} points {level.step_m:g} m apart, {level.directions} directions"
    yield f"{level.volume_m3:.3f} m³ reached, {grid}"


def _line(points: list[ReachPoint] | tuple[ReachPoint, ...]) -> str:
    (low_x, high_x), (low_y, high_y) = (
        (min(each.xyz[axis] for each in points), max(each.xyz[axis] for each in points)) for axis in (0, 1)
    )
    share = sum(each.share for each in points) / len(points)
    best = max(each.manipulability for each in points)
    xs, ys = f"{low_x:.2f} to {high_x:.2f}", f"{low_y:.2f} to {high_y:.2f}"
    return f"{len(points):>7} {xs:>16} {ys:>16} {100.0 * share:>9.0f} % {best:>15.3f}"


def reach_json(level: ReachLevel) -> str:
    """Return the level as JSON."""
    return msgspec.json.format(msgspec.json.encode(level)).decode() + "\n"


def reach_ply(level: ReachLevel) -> str:
    """Return the points as an ASCII PLY file in metres: red where one direction is reached, green where all are."""
    lines = [
        "ply",
        "format ascii 1.0",
        f"element vertex {len(level.points)}",
        *(f"property float {name}" for name in ("x", "y", "z")),
        *(f"property uchar {name}" for name in ("red", "green", "blue")),
        *(f"property float {name}" for name in ("share", "manipulability")),
        "end_header",
    ]
    for point in level.points:
        x, y, z = point.xyz
        green = round(255 * point.share)
        lines.append(f"{x:g} {y:g} {z:g} {255 - green} {green} 40 {point.share:.4f} {point.manipulability:.4f}")
    return "\n".join(lines) + "\n"
