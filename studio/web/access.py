"""Who may talk to the studio, and how much: addresses, the token, and limits on what a client sends."""

from __future__ import annotations

import hmac
import json
import re
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from thermograsp.errors import InvalidValueError

LARGEST = 2048  # bytes of a client's message
RATE, BURST = 40.0, 80.0  # messages a second, and at once
_TOKEN = re.compile(r"[A-Za-z0-9_-]{16,}")
_PORTS = {"http": ":80", "https": ":443"}  # that addresses leave out


@dataclass(frozen=True, slots=True)
class Access:
    """Who may open the studio's page. host: where the server listens. token: what every path begins with. Every address
    has one, for other users of this machine reach its loopback addresses too."""

    host: str
    token: str

    @classmethod
    def to(cls, host: str, token: str = "") -> Access:
        """Access with that token, a random one where it is empty. Raises InvalidValueError for one that is easily
        guessed."""
        if token and not _TOKEN.fullmatch(token):
            raise InvalidValueError("a token must have at least 16 letters, digits, - or _")
        return cls(host, token or secrets.token_urlsafe(24))

    def url(self, port: int) -> str:
        """What a visitor opens."""
        shown = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{shown}:{port}/{self.token}/"

    def resource(self, path: str) -> str | None:
        """What is asked for below the token, without its query; None for a wrong token."""
        given, _, rest = path.partition("?")[0].removeprefix("/").partition("/")
        return rest if hmac.compare_digest(given.encode(), self.token.encode()) else None

    def trusts(self, host: str | None, origin: str | None, forwarded: str | None = None) -> bool:
        """Whether a request's Origin is that of a page of ours: of its Host, or of the X-Forwarded-Host that a proxy
        adds, with or without encryption; of several proxies in a row, the first one's. A web page elsewhere may make
        its visitor's browser connect to us, but under its own Origin, and no page can add that header."""
        if host is None:
            return False
        if origin is None:
            return True
        scheme, _, place = origin.lower().partition("://")
        port = _PORTS.get(scheme)
        forwarded = forwarded and forwarded.partition(",")[0].strip()
        hosts = [one.lower().removesuffix(port) for one in (host, forwarded) if one and port]
        return place in hosts


class Allowance:
    """Messages that a client may still send: `RATE` a second, up to `BURST` at once. clock: s."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock, self._allowed, self._last = clock, BURST, clock()

    def take(self) -> bool:
        """False for one message too many."""
        now = self._clock()
        self._allowed = min(self._allowed + RATE * (now - self._last), BURST)
        self._last = now
        if self._allowed < 1:
            return False
        self._allowed -= 1
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
