"""Login and logout: the printed link, the form for a pasted token, and the session."""

from __future__ import annotations

from pathlib import Path
from typing import cast
from urllib.parse import parse_qs

from fastapi import HTTPException, Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse

from editor_web.http_bodies.common_bodies import (
    LoginLinkBody,
    LoginLinkRequest,
    SessionBody,
)
from editor_web.routes.services import Services, ServicesOf, role_of
from editor_web.routes.wire_router import WireRouter
from editor_web.security.authentication import OPERATOR, Role
from editor_web.security.login_sessions import ABSOLUTE_LIMIT_S, LINK_LIMIT_S, LoginSession
from editor_web.security.middleware import LOG_OUT, cookie_name, peer_of

router = WireRouter(tags=["session"])
MAX_FORM_BYTES = 1000
_SPENT = "This link has been used already or has expired: <code>flexcell login</code> prints a new one."


@router.get("/api/v1/session")
async def get_session(request: Request, services: ServicesOf) -> SessionBody:
    """Return the role of the session and the features of this server."""
    role, stop = role_of(request), services.stop
    return SessionBody(
        role=role,
        cell_name=services.backend.cell_name,
        cell_view_port=services.view_port,
        epoch=services.hub.epoch,
        cell=services.backend.cell_connection,
        devices=services.backend.reopening.devices,
        opening_problem=services.backend.reopening.problem,
        stop=stop if role == OPERATOR else None,
    )


@router.post(LOG_OUT, status_code=204)
async def log_out(request: Request, services: ServicesOf) -> Response:
    """End the session permanently; its websockets close."""
    session = _session_of(request)
    if session is not None:
        services.sessions.end(session)
    response = Response(status_code=204)
    response.delete_cookie(cookie_name(services.port), httponly=True, samesite="strict")
    return response


@router.post("/api/v1/login-links", status_code=201)
async def new_login_link(body: LoginLinkRequest, request: Request, services: ServicesOf) -> LoginLinkBody:
    """Create the token of a single-use login link: `/login?t=<token>`."""
    if _session_of(request) is not None:
        # Otherwise a misused page could outlive its own logout.
        raise HTTPException(403, "login links require the operator token: run `flexcell login`")
    return LoginLinkBody(token=services.sessions.new_link(body.role), expires_in_s=LINK_LIMIT_S)


@router.get("/login", include_in_schema=False)
async def log_in_page(request: Request, services: ServicesOf) -> Response:
    """Exchange the token of a login link for a session, or show the form."""
    token = request.query_params.get("t")
    # Neither another page nor a prefetching browser may use up the link.
    is_opened = request.headers.get("sec-fetch-site", "none") in ("none", "same-origin")
    if token is None or not is_opened or "prefetch" in request.headers.get("sec-purpose", ""):
        return _form(problem="")
    role = services.sessions.take_link(token)
    if role is not None:
        return _enter(role, services)
    if _session_of(request) is not None:
        return RedirectResponse("/", status_code=303)
    return _wrong(request, services, problem=_SPENT)


@router.post("/login", include_in_schema=False)
async def log_in(request: Request, services: ServicesOf) -> Response:
    """Exchange a pasted token, single-use or permanent, for a session."""
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > MAX_FORM_BYTES:
            return _form(problem="This is not a token.", status=413)
    fields = parse_qs(body.decode("ascii", "replace"))
    token = fields.get("token", [""])[0].strip()
    role = services.sessions.take_link(token) or services.access.role_of_token(token)
    if role is None:
        return _wrong(request, services, problem="That token is not valid for this server.")
    return _enter(role, services)


def _session_of(request: Request) -> LoginSession | None:
    return cast("LoginSession | None", request.state.session)


def _wrong(request: Request, services: Services, *, problem: str) -> Response:
    wait_s = services.limit.failed(peer_of(request.scope))
    if wait_s == 0:
        return _form(problem=problem, status=401)
    response = _form(problem=f"Too many wrong tokens. Try again in {int(wait_s) + 1} seconds.", status=429)
    response.headers["retry-after"] = str(int(wait_s) + 1)
    return response


def _enter(role: Role, services: Services) -> Response:
    response = RedirectResponse("/", status_code=303)
    response.set_cookie(
        cookie_name(services.port),
        services.sessions.begin(role),
        max_age=int(ABSOLUTE_LIMIT_S),
        httponly=True,
        samesite="strict",
        path="/",
    )
    return response


def _form(*, problem: str, status: int = 200) -> Response:
    page = (Path(__file__).parent.parent / "login.html").read_text(encoding="utf-8")
    note = f'<p class="problem" role="alert" id="problem">{problem}</p>' if problem else ""
    return HTMLResponse(page.replace("<!-- problem -->", note), status_code=status)
