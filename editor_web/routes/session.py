"""Logging in and out: the printed link, the form for a pasted token, and who one is."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import parse_qs

from fastapi import APIRouter, Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse

from editor_web.access import OPERATOR
from editor_web.routes.services import Services, ServicesOf, role_of
from editor_web.security import cookie_name
from editor_web.wire import ConnectionBody, SessionBody, StopEndpointBody

router = APIRouter(tags=["session"])
MAX_FORM_BYTES = 1000
SESSION_S = 30 * 24 * 3600


@router.get("/api/v1/session")
def get_session(request: Request, services: ServicesOf) -> SessionBody:
    """Say who is logged in and what this server has."""
    role, stop = role_of(request), services.stop
    return SessionBody(
        role=role,
        cell_name=services.backend.cell_name,
        has_cell_view=services.cell_view is not None,
        epoch=services.hub.epoch,
        cell=ConnectionBody.model_validate(services.backend.cell_connection),
        stop=StopEndpointBody(url=stop.url, token=stop.token) if stop is not None and role == OPERATOR else None,
    )


@router.post("/api/v1/logout", status_code=204)
def log_out(services: ServicesOf) -> Response:
    """Take the session cookie back."""
    response = Response(status_code=204)
    response.delete_cookie(cookie_name(services.port), httponly=True, samesite="strict")
    return response


@router.get("/login", include_in_schema=False)
def log_in_page(request: Request, services: ServicesOf) -> Response:
    """Exchange the token of the printed link for the cookie, or show the form."""
    token = request.query_params.get("t")
    if token is None or request.headers.get("sec-fetch-site") == "cross-site":
        return _form(problem="")
    return _enter(token, services)


@router.post("/login", include_in_schema=False)
async def log_in(request: Request, services: ServicesOf) -> Response:
    """Exchange a pasted token for the cookie."""
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > MAX_FORM_BYTES:
            return _form(problem="That is not a token.", status=413)
    fields = parse_qs(body.decode("ascii", "replace"))
    return _enter(fields.get("token", [""])[0].strip(), services)


def _enter(token: str, services: Services) -> Response:
    wait_s = services.limit.wait_s()
    if wait_s > 0:
        response = _form(problem=f"Too many wrong tokens. Try again in {int(wait_s) + 1} seconds.", status=429)
        response.headers["retry-after"] = str(int(wait_s) + 1)
        return response
    role = services.access.role_of_token(token)
    if role is None:
        services.limit.failed()
        return _form(problem="That token is not valid for this server.", status=401)
    response = RedirectResponse("/", status_code=303)
    response.set_cookie(
        cookie_name(services.port),
        services.access.session(role),
        max_age=SESSION_S,
        httponly=True,
        samesite="strict",
        path="/",
    )
    return response


def _form(*, problem: str, status: int = 200) -> Response:
    page = (Path(__file__).parent.parent / "login.html").read_text(encoding="utf-8")
    note = f'<p class="problem" role="alert" id="problem">{problem}</p>' if problem else ""
    return HTMLResponse(page.replace("<!-- problem -->", note), status_code=status)
