"""The server answers at each address that the page makes up for its views."""

from __future__ import annotations

import re
from pathlib import Path

from fastapi.routing import APIRoute

from editor_web.routes import page

ROUTES = Path(page.__file__).parents[1] / "frontend" / "src" / "app" / "route.ts"


def test_every_page_can_be_loaded_by_its_address() -> None:
    """Also when a person reloads it, or follows a link from elsewhere."""
    served = {route.path.split("/")[1] for route in page.router.routes if isinstance(route, APIRoute)}
    known = set(re.findall(r"page === '([a-z]+)'", ROUTES.read_text()))
    assert len(known) > 5
    assert known <= served
