"""The dashboard: a FastAPI application that shows and runs behaviors and draws the cell.

It depends on `engine` alone: `contracts.backend` declares the interface to the engine, `app` serves it, `live` streams
it, `cell_view` draws it, and `frontend/` is the page (built into `static/`).
"""

from editor_web.app import new_app
from editor_web.contracts.backend import Backend
from editor_web.server import Dashboard, dashboard, serve

__all__ = ["Backend", "Dashboard", "dashboard", "new_app", "serve"]
