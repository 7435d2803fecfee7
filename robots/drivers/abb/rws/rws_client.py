"""HTTP with digest authentication to Robot Web Services 1.0; each failure has its cause."""

from __future__ import annotations

from collections.abc import Mapping

import httpx

from robots.drivers.abb.abb_faults import AbbFault, AbbLinkError
from robots.drivers.abb.rws.captured_http import CapturedTransport
from robots.drivers.abb.rws.rws_state import error_text
from robots.io.wire.wire_tap import NO_TAP, WireTap

_MOST_BYTES = 1 << 20
_UNAUTHORIZED, _UNAVAILABLE = 401, 503


class RwsRefused(Exception):
    """The controller is there, and does not do what it was asked."""


class RwsClient:
    """One session: the controller has few, and its cookie keeps it.

    Args:
        host: Where the controller is.
        port: Of its web server.
        user: Who asks.
        password: Of the user.
        timeout_s: Time limit of each request.
        tap: Notes what is sent and received, without credentials and cookies.
    """

    def __init__(
        self, host: str, port: int, *, user: str, password: str, timeout_s: float, tap: WireTap = NO_TAP
    ) -> None:
        self._timeout_s = timeout_s
        # Proxies of the environment are not for a controller in the cell's own network.
        self._http = httpx.Client(
            base_url=f"http://{host}:{port}",
            auth=httpx.DigestAuth(user, password),
            timeout=timeout_s,
            trust_env=False,
            transport=CapturedTransport(tap) if tap.is_active else None,
            follow_redirects=False,
        )

    def get(self, path: str, **parameters: str) -> bytes:
        """Return the answer for a resource that every controller has; raises AbbLinkError."""
        try:
            return self.look_up(path, **parameters)
        except RwsRefused as error:
            raise AbbLinkError(AbbFault.REFUSED, f"RWS refuses {path}: {error}") from error

    def look_up(self, path: str, **parameters: str) -> bytes:
        """Return the answer for a resource.

        Raises:
            RwsRefused: the controller does not have it, or does not tell it; says why.
            AbbLinkError: it does not answer.
        """
        return self._ask("GET", path, parameters)

    def post(self, path: str, action: str, values: Mapping[str, str]) -> None:
        """Ask for an action.

        Raises:
            RwsRefused: the controller does not do it; says why.
            AbbLinkError: it does not answer.
        """
        self._ask("POST", path, {"action": action}, values=values)

    def close(self) -> None:
        """Log out, so that the controller has its session back, and disconnect."""
        try:
            if self._http.cookies:
                self._http.get("/logout")
        except httpx.HTTPError:
            pass  # the controller is gone, and its session ends by itself
        finally:
            self._http.close()

    def _ask(
        self, method: str, path: str, parameters: Mapping[str, str], *, values: Mapping[str, str] | None = None
    ) -> bytes:
        try:
            with self._http.stream(method, path, params={**parameters, "json": "1"}, data=values) as response:
                body = _limited(response)
        except httpx.TimeoutException as error:
            raise AbbLinkError(AbbFault.SILENT, f"RWS did not answer within {self._timeout_s:g} s") from error
        except httpx.TransportError as error:
            if isinstance(error, httpx.RemoteProtocolError) and "disconnected" not in str(error):
                raise AbbLinkError(AbbFault.GARBAGE, f"RWS sent no HTTP: {error}") from error
            raise AbbLinkError(AbbFault.LINK_CUT, f"RWS cannot be reached: {error}") from error
        except (httpx.HTTPError, httpx.InvalidURL, ValueError) as error:
            raise AbbLinkError(AbbFault.GARBAGE, f"RWS sent no answer: {error}") from error
        if response.is_success:
            return body
        if response.status_code == _UNAUTHORIZED:
            raise AbbLinkError(AbbFault.REFUSED, "RWS refuses user or password")
        if response.status_code == _UNAVAILABLE:
            raise AbbLinkError(AbbFault.REFUSED, "RWS has no free session")
        raise RwsRefused(f"HTTP {response.status_code} {error_text(body)}".strip())


def _limited(response: httpx.Response) -> bytes:
    """Return the body; raises AbbLinkError where it does not end."""
    body = bytearray()
    for part in response.iter_bytes():
        body += part
        if len(body) > _MOST_BYTES:
            raise AbbLinkError(AbbFault.GARBAGE, f"RWS sent more than {_MOST_BYTES} bytes")
    return bytes(body)
