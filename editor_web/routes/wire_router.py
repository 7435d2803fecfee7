"""Routes that take and return msgspec types: the engine's structs are the bodies of requests and responses.

A parameter whose type is a struct is the body of the request, decoded and checked by msgspec. What a function returns
is sent as JSON, as its annotation says: a struct, a dataclass, or a container of them. FastAPI itself sees only the
parameters of path, query and header; of the bodies it gets references to their schemas (`editor_web.http_bodies`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Coroutine
from email.message import Message
from functools import wraps
from http import HTTPStatus
from inspect import Parameter, Signature, iscoroutinefunction, signature
from types import NoneType
from typing import Annotated, Any, get_args, get_type_hints

import msgspec
from fastapi import APIRouter, Depends, Request, Response

from editor_web.http_bodies.json_schemas import BodyTypes, alternatives, reference_to

_AT = re.compile(r"^(?P<what>.*?)(?: - at `(?:key in )?\$(?P<path>.*)`)?$", re.DOTALL)
_FIELD = re.compile(r"(?:missing required|contains unknown) field `(.*)`")


class MalformedBody(Exception):
    """The body of a request is not what the route expects; `where` is the field, `begin.seq`."""

    def __init__(self, message: str, where: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.where = where


def json_response(value: object, status: int = HTTPStatus.OK) -> Response:
    """Return a value as JSON."""
    return Response(msgspec.json.encode(value), status, media_type="application/json")


class WireRouter(APIRouter):
    """A router for functions with msgspec types; `bodies` are the types of all its bodies."""

    def __init__(self, **options: Any) -> None:
        self.bodies = BodyTypes()
        options["responses"] = self._described(options.get("responses"))
        super().__init__(**options)

    def add_api_route(self, path: str, endpoint: Callable[..., Any], **options: Any) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Add a route; `{"model": Struct}` in `responses` is the body of another response."""
        hints = get_type_hints(endpoint, include_extras=True)
        # A function may answer a special case with a response of its own.
        returned = _without_response(hints.pop("return", NoneType))
        responses = self._described(options.get("responses"))
        for each in signature(endpoint).parameters.values():
            if _is_body(hints[each.name]):
                self.bodies.taken.append(hints[each.name])
                required = each.default is Parameter.empty
                options["openapi_extra"] = {"requestBody": {**_content(hints[each.name]), "required": required}}
        status = options.get("status_code") or HTTPStatus.OK
        sends = returned is not NoneType
        if sends:
            self.bodies.sent.append(returned)
            responses[int(status)] = _content(returned)
        options |= {"response_model": None, "responses": responses}
        super().add_api_route(path, _wired(endpoint, hints, status=status if sends else None), **options)

    def _described(self, responses: dict[int | str, dict[str, Any]] | None) -> dict[int | str, dict[str, Any]]:
        described: dict[int | str, dict[str, Any]] = {}
        for status, response in (responses or {}).items():
            kind = response.get("model")
            described[status] = response if kind is None else _content(kind)
            if kind is not None:
                self.bodies.sent.extend(alternatives(kind))
        return described


def _without_response(returned: Any) -> Any:
    options = (returned,) if returned is Response else get_args(returned)
    return next((each for each in options if each is not Response), NoneType) if Response in options else returned


def _content(kind: Any) -> dict[str, Any]:
    return {"content": {"application/json": {"schema": reference_to(kind)}}}


def _is_body(kind: Any) -> bool:
    return any(isinstance(each, type) and issubclass(each, msgspec.Struct) for each in (kind, *get_args(kind)))


def _wired(endpoint: Callable[..., Any], hints: dict[str, Any], *, status: int | None) -> Callable[..., Any]:
    """Return the function as FastAPI calls it: its body is a dependency, its result is a response with `status`.

    Without `status` it returns nothing, or a response of its own.
    """

    def responded(result: Any) -> Any:
        return result if status is None or isinstance(result, Response) else json_response(result, status)

    @wraps(endpoint)
    async def wait_and_respond(**arguments: Any) -> Any:
        return responded(await endpoint(**arguments))

    @wraps(endpoint)
    def respond(**arguments: Any) -> Any:
        return responded(endpoint(**arguments))

    wired: Any = wait_and_respond if iscoroutinefunction(endpoint) else respond
    wired.__signature__ = Signature([_parameter(each, hints) for each in signature(endpoint).parameters.values()])
    return wired


def _parameter(parameter: Parameter, hints: dict[str, Any]) -> Parameter:
    kind = hints[parameter.name]
    if not _is_body(kind):
        return parameter.replace(annotation=kind, kind=Parameter.KEYWORD_ONLY)
    read = Annotated[Any, Depends(_body_reader(kind))]
    return Parameter(parameter.name, Parameter.KEYWORD_ONLY, annotation=read)


def _body_reader(kind: Any) -> Callable[[Request], Coroutine[Any, Any, Any]]:
    decoder: msgspec.json.Decoder[Any] = msgspec.json.Decoder(kind)
    may_be_absent = NoneType in get_args(kind)

    async def read_body(request: Request) -> Any:
        data = await request.body()
        if not data and may_be_absent:
            return None
        if not _is_json(request):
            raise MalformedBody("expected JSON, with `content-type: application/json`")
        return decode_body(decoder, data)

    return read_body


def decode_body(decoder: msgspec.json.Decoder[Any], data: bytes) -> Any:
    """Return the decoded body of a request; raises MalformedBody."""
    try:
        return decoder.decode(data)
    except msgspec.ValidationError as error:
        # Without its chain: the text that failed is not for the log.
        raise _malformed(str(error)) from None
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        # msgspec raises RecursionError for too deep nesting.
        raise MalformedBody(str(error)) from None


def _malformed(text: str) -> MalformedBody:
    match = _AT.match(text)
    what, path = (match["what"], match["path"] or "") if match else (text, "")
    field = _FIELD.search(what)
    parts = [part for part in re.split(r"[.\[\]]+", path) if part]
    return MalformedBody(what, ".".join([*parts, *([field[1]] if field else [])]))


def _is_json(request: Request) -> bool:
    header = Message()
    header["content-type"] = request.headers.get("content-type", "")
    subtype = header.get_content_subtype()
    return header.get_content_maintype() == "application" and (subtype == "json" or subtype.endswith("+json"))
