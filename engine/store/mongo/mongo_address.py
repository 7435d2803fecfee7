"""Addresses of MongoDB servers: secrets come from the environment and never appear in messages."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from urllib.parse import quote_plus

from engine.errors import StoreError

SCHEMES = ("mongodb://", "mongodb+srv://")
_VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)\}")
_USERINFO = re.compile(r"(?<=://)(?P<user>[^@/:]*)(?::(?P<password>[^@/]*))?@")


def is_mongo_address(text: str) -> bool:
    """Return whether `text` is the address of a MongoDB server and not a file path."""
    return text.startswith(SCHEMES)


def with_environment(uri: str, environment: Mapping[str, str] | None = None) -> str:
    """Return an address with each `${NAME}` replaced by that environment variable.

    A variable that is the whole address is not escaped; a part of an address, such as a password, is
    escaped, so that it may have any character.

    Raises:
        StoreError: a variable is not set.
    """
    values = os.environ if environment is None else environment

    def value(match: re.Match[str]) -> str:
        name = match[1]
        if name not in values:
            raise StoreError(
                f"the environment variable {name} is not set",
                where=public_address(uri),
                hint="set it in the environment of flexcell; the cell refers to it so that the file has no secret",
            )
        return values[name] if match[0] == uri else quote_plus(values[name])

    return _VARIABLE.sub(value, uri)


def public_address(uri: str, database: str = "") -> str:
    """Return an address without user, password and options, for messages, with its database."""
    bare = _USERINFO.sub("", uri).split("?", 1)[0].rstrip("/")
    scheme, found, rest = bare.partition("://")
    if not found:
        return bare
    host = rest.split("/", 1)[0]
    return f"{scheme}://{host}" + (f"/{database}" if database else "")


def user_of(uri: str) -> str:
    """Return the user that an address names, empty for none."""
    found = _USERINFO.search(uri)
    return found["user"] if found is not None else ""
