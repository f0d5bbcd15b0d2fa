"""Who may talk to the studio, and how much."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from thermograsp.errors import InvalidValueError
from thermograsp.view.access import BURST, LARGEST, RATE, Access, Allowance, is_loopback, parsed


@pytest.mark.parametrize("host", ["127.0.0.1", "127.9.9.9", "::1", "[::1]", "localhost"])
def test_a_loopback_address_needs_no_token(host: str) -> None:
    assert is_loopback(host)
    assert Access.to(host).token == ""


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.7", "example.org", "localhost.example.org", ""])
def test_any_other_address_gets_a_token_of_its_own(host: str) -> None:
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
    assert Access("127.0.0.1", "").resource("/main.js?x") == "main.js"


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
        ("evil.example.org:8421", "http://evil.example.org:8421", False),  # a name that points to us
        (None, None, False),
    ],
)
def test_pages_of_others_are_not_trusted(host: str | None, origin: str | None, trusted: bool) -> None:
    assert Access.to("127.0.0.1").trusts(host, origin) is trusted


def test_with_a_token_any_name_will_do_but_the_page_must_be_ours() -> None:
    access = Access.to("0.0.0.0")
    assert access.trusts("lab.example.org:8421", "http://lab.example.org:8421")
    assert not access.trusts("lab.example.org:8421", "http://example.org")


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
