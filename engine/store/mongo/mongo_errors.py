"""Describes errors between a store and its MongoDB server, with advice."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

from bson.errors import BSONError
from pymongo.errors import (
    AutoReconnect,
    ConfigurationError,
    ConnectionFailure,
    DocumentTooLarge,
    InvalidURI,
    OperationFailure,
    PyMongoError,
)

from engine.errors import StoreError

_AUTHENTICATION_FAILED = 18
_UNAUTHORIZED = 13
_OUT_OF_DISK = 14031
_DOCUMENT_TOO_LARGE = (10334, 17419, 17420)
_TOO_LARGE = ("the entry exceeds MongoDB's limit of 16 MiB", "split it into several entries")
_REACH = (
    "check that mongod runs there and its disk has room, that the address and port are right, and that no firewall is"
    " between"
)
_IN_DOUBT = "the interrupted write may have taken effect: read the entry before writing it again"


def is_retryable(error: PyMongoError) -> bool:
    """Return whether the operation can be repeated over a new connection after this error."""
    return isinstance(error, AutoReconnect) or error.has_error_label("RetryableWriteError")


@contextmanager
def translate_mongo_errors(what: str, *, address: str, user: str = "", writing: bool = False) -> Generator[None]:
    """Convert errors of the driver to StoreError.

    Args:
        what: The failed operation, such as `cannot be read`.
        address: The server and database, without secrets.
        user: The logged-in user.
        writing: Whether the operation writes, and may have taken effect although it failed.
    """
    try:
        yield
    except (PyMongoError, BSONError) as error:
        message, hint = _describe(error, user=user, writing=writing)
        raise StoreError(f"the store {what}: {message}", where=address, hint=hint) from error


def _describe(error: PyMongoError | BSONError, *, user: str, writing: bool) -> tuple[str, str]:
    who = f"the user {user}" if user else "an anonymous client (no user is given)"
    if isinstance(error, DocumentTooLarge):
        return _TOO_LARGE
    if isinstance(error, BSONError):
        return f"{error}", "check the values of the entry"
    if isinstance(error, OperationFailure):
        return _refusal(error, who)
    if isinstance(error, InvalidURI):
        return f"the address is invalid: {error}", "write it as mongodb://HOST:PORT"
    if isinstance(error, ConfigurationError):
        if "wire version" in str(error):
            return "the server is too old", "use MongoDB 5.0 or newer"
        return f"{error}", "check the address and its options"
    if isinstance(error, ConnectionFailure) or error.timeout:
        reason = str(error).split(", Timeout:", 1)[0].split(" (configured timeouts", 1)[0]
        return f"the server cannot be reached: {reason}", f"{_REACH}; {_IN_DOUBT}" if writing else _REACH
    return f"{error}", "check the log of mongod"


def _refusal(error: OperationFailure, who: str) -> tuple[str, str]:
    text = str((error.details or {}).get("errmsg", error))
    if error.code == _AUTHENTICATION_FAILED:
        return f"the server refuses the credentials of {who}", "check user, password and `?authSource=`"
    if error.code == _UNAUTHORIZED:
        return f"{who} has no permission: {text}", "log in as a user with the role readWrite on this database"
    if error.code == _OUT_OF_DISK or "No space left" in text:
        return "the disk of the server is full", "free some space on it"
    if error.code in _DOCUMENT_TOO_LARGE:
        return _TOO_LARGE
    if error.timeout:
        return f"the server does not answer in time: {text}", f"{_REACH}; {_IN_DOUBT}"
    return text, "check the log of mongod"
