"""Services of every route, stored on the application: the backend, the hub, the tokens, the cell view."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, cast

from fastapi import Depends
from starlette.requests import HTTPConnection

from editor_web.cell_view import CellView
from editor_web.live.hub import LiveHub
from editor_web.security.authentication import AccessTokens, AttemptLimiter
from editor_web.security.login_sessions import LoginSessions
from engine.editing import DocumentRepository, TargetChecks
from engine.project import Session
from engine.stop import StopEndpoint
from engine.sweep_library import SweepService


@dataclass(frozen=True, kw_only=True)
class Services:
    """The services of one server; `cell_view` and `view_port` are None if the 3D view is disabled."""

    backend: Session
    hub: LiveHub
    access: AccessTokens
    sessions: LoginSessions
    limit: AttemptLimiter
    targets: TargetChecks
    sweeps: SweepService
    cell_view: CellView | None
    static: Path
    port: int
    view_port: int | None = None
    stop: StopEndpoint | None = None

    @property
    def documents(self) -> DocumentRepository:
        """The behaviors of the project as editable files."""
        return self.backend.documents


def services_of(connection: HTTPConnection) -> Services:
    """Return the services of the application that serves this request or websocket."""
    return cast("Services", connection.app.state.services)


def role_of(connection: HTTPConnection) -> str:
    """Return the role that the security middleware set for this request or websocket."""
    return str(connection.state.role)


ServicesOf = Annotated[Services, Depends(services_of)]
