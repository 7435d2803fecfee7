"""The dashboard: a FastAPI application that shows and runs behaviors and draws the cell.

It depends on `engine` alone: `app` serves a session of the engine, `live` streams it, `cell_view` draws it, and
`frontend/` is the page (built into `static/`).
"""

from editor_web.app import new_app
from editor_web.server import Dashboard, dashboard, serve

__all__ = ["Dashboard", "dashboard", "new_app", "serve"]
