"""The links of an arm with its tool, by name."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from functools import lru_cache

from robots.model.robot_model import RobotModel


@lru_cache(maxsize=32)
def link_names(model: RobotModel) -> frozenset[str]:
    """Return the names of all links."""
    return frozenset(link.attrib["name"] for link in ET.fromstring(model.urdf_text).findall("link"))  # noqa: S314 - our composed URDF
