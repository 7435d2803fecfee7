"""The presets of realism: in order, all fields in use, and as documented."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path
from typing import get_args

import pytest

from engine.document import RealismName
from robots.scene.realism import IDEAL, Realism, realism

PAGE = Path(__file__).parents[3] / "docs" / "how-to" / "make-arms-realistic.md"
ROW = re.compile(r"^\| `(\w+)`: .* \| ([\d.e-]+) \| ([\d.e-]+) \|$", re.MULTILINE)
NAMES = [field.name for field in fields(Realism)]


def test_every_error_grows_from_ideal_over_typical_to_poor() -> None:
    assert get_args(RealismName) == ("ideal", "typical", "poor")
    assert realism("ideal") == IDEAL
    for name in NAMES:
        assert 0.0 == getattr(IDEAL, name) < getattr(realism("typical"), name) < getattr(realism("poor"), name), name


def test_the_page_has_the_figures_of_the_presets() -> None:
    rows = {name: (float(typical), float(poor)) for name, typical, poor in ROW.findall(PAGE.read_text("utf-8"))}
    assert list(rows) == NAMES
    for name, figures in rows.items():
        found = (getattr(realism("typical"), name), getattr(realism("poor"), name))
        assert figures == pytest.approx(found, rel=0.01), name
