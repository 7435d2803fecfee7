"""The addresses of all websockets, and the messages that pages send on them, as the server declares them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module
from pkgutil import iter_modules
from typing import get_args

import msgspec
from fastapi import APIRouter
from fastapi.routing import APIWebSocketRoute

import editor_web.routes
import editor_web.sockets
from editor_web.live.live_frames import Request
from editor_web.sockets.cell_past_view import PastViewRequest
from editor_web.teaching.handle_drag import DragKeepAlive, ShowHandle
from editor_web.teaching.teaching_messages import FromPage
from editor_web.telemetry.data_frames import DataSubscription

MESSAGES: tuple[type[msgspec.Struct], ...] = (
    *get_args(Request), *get_args(FromPage), DataSubscription, ShowHandle, DragKeepAlive, PastViewRequest,
)  # fmt: skip


def socket_paths(page: str) -> list[str]:
    """Return the addresses of all websockets, with the name of this page where one stands in an address."""
    return sorted(re.sub(r"\{\w+\}", page, path) for path in _paths())


def message_tags() -> list[str]:
    """Return the first word of each message."""
    return [str(kind.__struct_config__.tag) for kind in MESSAGES if kind.__struct_config__.tag]


def message_fields() -> list[str]:
    """Return the fields of all messages."""
    return sorted({field for kind in MESSAGES for field in kind.__struct_fields__})


def _paths() -> Iterator[str]:
    for room in (editor_web.routes, editor_web.sockets):
        for found in iter_modules(room.__path__, f"{room.__name__}."):
            router = getattr(import_module(found.name), "router", None)
            if isinstance(router, APIRouter):
                yield from (route.path for route in router.routes if isinstance(route, APIWebSocketRoute))
