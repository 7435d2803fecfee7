"""A link that logs a browser in once, made with the operator's token of a running server."""

from __future__ import annotations

import httpx


def login_link(url: str, token: str) -> str:
    """Return a new link of the server at `url`."""
    answer = httpx.post(
        f"{url}api/v1/login-links", json={}, headers={"Authorization": f"Bearer {token}"}, timeout=30.0, trust_env=False
    )
    return f"{url}login?t={answer.raise_for_status().json()['token']}"
