"""The built page: its files, and `index.html` for every client-side route."""

from __future__ import annotations

import re
from pathlib import Path

from fastapi import APIRouter, HTTPException
from fastapi.responses import FileResponse, HTMLResponse, Response

from editor_web.routes.services import ServicesOf

router = APIRouter(include_in_schema=False)
_ASSET = re.compile(r"[0-9A-Za-z_-][0-9A-Za-z_.-]{0,199}")
NOT_BUILT = (
    "<!doctype html><html lang=en><title>flexcell</title><h1>The page is not built</h1>"
    "<p>Run <code>pip install -e .</code> in the project, then reload.</p></html>"
)


@router.get("/assets/{name:path}")
def asset(name: str, services: ServicesOf) -> Response:
    """Serve one built file; its name contains a hash of the content, so browsers may cache it without limit."""
    file = services.static / "assets" / name
    # A name that the build cannot produce never reaches the file system.
    if not _ASSET.fullmatch(name) or not file.is_file():
        raise HTTPException(404, "no such file")
    return FileResponse(file, headers={"cache-control": "public, max-age=31536000, immutable"})


@router.get("/favicon.svg")
def icon(services: ServicesOf) -> Response:
    """Serve the icon."""
    return _served(services.static / "favicon.svg")


@router.get("/THIRD-PARTY-NOTICES.txt")
def notices(services: ServicesOf) -> Response:
    """Serve the third-party licences of the page."""
    return _served(services.static / "THIRD-PARTY-NOTICES.txt")


@router.get("/")
@router.get("/behaviors/{rest:path}")
@router.get("/runs")
@router.get("/runs/{rest:path}")
@router.get("/beside/{rest:path}")
@router.get("/compare/{rest:path}")
@router.get("/trends/{rest:path}")
@router.get("/past")
@router.get("/recordings/{rest:path}")
@router.get("/edit/{rest:path}")
@router.get("/teach")
@router.get("/workcell")
@router.get("/workcell/{rest:path}")
@router.get("/sweeps")
@router.get("/sweeps/{rest:path}")
def index(services: ServicesOf, rest: str = "") -> Response:
    """Serve the page, which routes `rest` itself."""
    del rest
    file = services.static / "index.html"
    return FileResponse(file, media_type="text/html") if file.is_file() else HTMLResponse(NOT_BUILT, status_code=503)


def _served(file: Path) -> Response:
    if not file.is_file():
        raise HTTPException(404, "no such file")
    return FileResponse(file)
