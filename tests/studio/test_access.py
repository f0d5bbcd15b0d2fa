"""Who may talk to the studio, and how much."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from thermograsp.errors import InvalidValueError
from thermograsp.studio.web.access import (
    BURST,
    LARGEST,
    RATE,
    Access,
    Allowance,
    parsed,
)


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost", "0.0.0.0", "192.168.1.7", "example.org"])
def test_every_address_gets_a_token_of_its_own(host: str) -> None:
    """A loopback address too: every user of the machine reaches it."""
    first, second = Access.to(host), Access.to(host)
    assert len(first.token) >= 32 and first.token != second.token
    assert first.token in first.url(80)


def test_a_resource_is_below_the_token() -> None:
    access = Access("0.0.0.0", "secret")
    assert access.resource("/secret/main.js?x=1") == "main.js"
    assert access.resource("/secret/") == ""
    for path in (
        "/",
        "/main.js",
        "/secre/main.js",
        "/secrets/main.js",
        "//secret/main.js",
        "/s\u00e9cret/",
        "secret",
    ):
        assert access.resource(path) in (None, ""), path
        assert access.resource(path) is None or path == "secret"


def test_a_token_may_be_given_but_not_an_easy_one() -> None:
    assert Access.to("127.0.0.1", "0123456789abcdef").token == "0123456789abcdef"
    for easy in ("secret", "0123456789 abcdef", "../0123456789abcdef"):
        with pytest.raises(InvalidValueError, match="at least 16 letters"):
            Access.to("127.0.0.1", easy)


@pytest.mark.parametrize(
    ("host", "origin", "trusted"),
    [
        ("127.0.0.1:8421", "http://127.0.0.1:8421", True),
        ("localhost:8421", "http://localhost:8421", True),
        ("[::1]:8421", "http://[::1]:8421", True),
        ("127.0.0.1:8421", None, True),  # not a browser
        ("127.0.0.1:8421", "http://example.org", False),  # another page's script
        ("127.0.0.1:8421", "http://127.0.0.1:9999", False),  # another server's page
        ("127.0.0.1:8421", "null", False),  # a file or a sandboxed frame
        ("127.0.0.1:8421", "file://127.0.0.1:8421", False),
        ("lab.example.org:8421", "http://lab.example.org:8421", True),  # the token is what keeps others out
        ("lab.example.org:8421", "http://example.org", False),
        (None, None, False),
    ],
)
def test_pages_of_others_are_not_trusted(host: str | None, origin: str | None, trusted: bool) -> None:
    assert Access.to("127.0.0.1").trusts(host, origin) is trusted


@pytest.mark.parametrize(
    ("host", "origin", "forwarded", "trusted"),
    [
        ("lab.example.org", "https://lab.example.org", None, True),
        ("lab.example.org:443", "https://LAB.example.org", None, True),
        ("127.0.0.1:8421", "https://lab.example.org", "lab.example.org", True),
        (
            "127.0.0.1:8421",
            "https://lab.example.org",
            "lab.example.org, inner.example.org",
            True,
        ),  # two in a row
        ("127.0.0.1:8421", "https://inner.example.org", "lab.example.org, inner.example.org", False),
        ("127.0.0.1:8421", "https://lab.example.org", "", False),
        ("127.0.0.1:8421", "https://lab.example.org", None, False),
        ("127.0.0.1:8421", "https://example.org", "lab.example.org", False),
        ("lab.example.org", "https://lab.example.org.evil.org", None, False),
    ],
)
def test_a_proxy_may_add_encryption(host: str, origin: str, forwarded: str | None, trusted: bool) -> None:
    assert Access.to("127.0.0.1").trusts(host, origin, forwarded) is trusted


def test_the_allowance_is_a_burst_and_a_rate() -> None:
    now = itertools.count(0.0, 0.0)
    allowance = Allowance(lambda: next(now))
    assert sum(allowance.take() for _ in range(1000)) == BURST
    clock = itertools.count(0.0, 1e-3)
    allowance = Allowance(lambda: next(clock))
    taken = sum(allowance.take() for _ in range(10_000))  # in 10 s
    assert BURST + 10 * RATE - 1 <= taken <= BURST + 10 * RATE + 1


@given(st.one_of(st.text(max_size=LARGEST), st.binary(max_size=LARGEST)))
def test_whatever_comes_is_a_message_or_refused(text: str | bytes) -> None:
    try:
        assert isinstance(parsed(text), dict)
    except InvalidValueError:
        pass


@pytest.mark.parametrize("text", ["[" * 2000, '{"a":' * 400, "1", "null", "[]", '"x"', "{", b"\xff\xfe"])
def test_what_is_no_object_is_refused(text: str | bytes) -> None:
    with pytest.raises(InvalidValueError, match="JSON object"):
        parsed(text)
