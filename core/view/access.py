"""Who may talk to the studio, and how much: addresses, the token, and limits on what a client sends."""

from __future__ import annotations

import hmac
import ipaddress
import json
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from thermograsp.errors import InvalidValueError

LARGEST = 2048  # bytes of a client's message
RATE, BURST = 40.0, 80.0  # messages a second, and at once
LOOPBACK = "127.0.0.1"
_NAMES = ("localhost",)


def is_loopback(host: str) -> bool:
    """Whether only this machine reaches it."""
    if host in _NAMES:
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


@dataclass(frozen=True, slots=True)
class Access:
    """host: where the server listens. token: what every path begins with, "" for none."""

    host: str
    token: str

    @classmethod
    def to(cls, host: str) -> Access:
        """Without a token on a loopback address, with a random one elsewhere."""
        return cls(host, "" if is_loopback(host) else secrets.token_urlsafe(24))

    def url(self, port: int) -> str:
        """What a visitor opens."""
        shown = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{shown}:{port}/{self.token + '/' if self.token else ''}"

    def resource(self, path: str) -> str | None:
        """What is asked for below the token, without its query; None for a wrong token."""
        parts = path.partition("?")[0].removeprefix("/")
        if not self.token:
            return parts
        given, _, rest = parts.partition("/")
        return rest if hmac.compare_digest(given.encode(), self.token.encode()) else None

    def trusts(self, host: str | None, origin: str | None) -> bool:
        """Whether a request's Host and Origin are those of a page of ours. A web page elsewhere may make its visitor's
        browser connect to a loopback address, under its own Origin, or under a name of its own that it has pointed
        there (DNS rebinding)."""
        if host is None:
            return False
        if not self.token and not is_loopback(urlsplit(f"//{host}").hostname or ""):
            return False
        return origin is None or origin == f"http://{host}"


class Allowance:
    """Messages that a client may still send: `RATE` a second, up to `BURST` at once. clock: s."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock, self._left, self._last = clock, BURST, clock()

    def take(self) -> bool:
        """False for one message too many."""
        now = self._clock()
        self._left = min(self._left + RATE * (now - self._last), BURST)
        self._last = now
        if self._left < 1:
            return False
        self._left -= 1
        return True


def parsed(text: str | bytes) -> dict[str, Any]:
    """A client's message. Raises InvalidValueError for what is no JSON object."""
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        message = None
    if not isinstance(message, dict):
        raise InvalidValueError("a message must be a JSON object")
    return message
