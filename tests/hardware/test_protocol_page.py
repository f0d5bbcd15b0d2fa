"""docs/protocol.md and the code say the same; an encoder of its own, written from the page, makes the same bytes."""

import json
import math
import re
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from thermograsp.hardware.protocol.decoder import Decoder
from thermograsp.hardware.protocol.frame import Frame, encode_frame
from thermograsp.hardware.protocol.messages import (
    CODES,
    LAYOUTS,
    LENGTHS,
    MESSAGES,
    Code,
    Flag,
    HeatersOff,
    decode_message,
    encode_message,
)

PAGE = (Path(__file__).parents[2] / "docs" / "protocol.md").read_text(encoding="utf-8")
PER_UNIT = {
    "": 0, "s": 0, "Hz": 0, "nV": 1e9, "pV": 1e12, "mV": 1e3, "mW": 1e3, "mA": 1e3,
    "0.01 °C": 100, "0.01 N": 100, "1e-6": 1e6, "1e-4": 1e4,
}  # fmt: skip
LETTERS = {"uint8": "B", "uint16": "H", "uint32": "I", "uint64": "Q", "int16": "h", "int32": "i"}

Row = tuple[int, str, tuple[int, ...], str, str]  # offset, type, shape, field, unit


def tables() -> dict[str, tuple[int, int, list[Row]]]:
    """Code, length and rows of each message's table, by name; SET_CALIBRATION's are CALIBRATION's."""
    found = {}
    for code, name, length, body in re.findall(
        r"### (\w\w) (\w+): (\d+) bytes?\n(.*?)(?=\n##|\Z)", PAGE, re.DOTALL
    ):
        rows = [
            (int(offset), kind, tuple(int(n) for n in re.findall(r"\d+", shape)), field, unit)
            for offset, kind, shape, field, unit in re.findall(
                r"\| (\d+) \| (u?int\d+)([\[\]\d]*) \| (\w+) \| (.*?) ?\|", body
            )
        ]
        found[name] = (int(code, 16), int(length), rows)
    code, length, _ = found["SET_CALIBRATION"]
    found["SET_CALIBRATION"] = (code, length, found["CALIBRATION"][2])
    return found


def golden() -> Iterator[tuple[str, dict[str, int], bytes, dict[str, Any]]]:
    block = re.findall(r"```golden\n(.*?)```", PAGE, re.DOTALL)[0]
    for entry in block.strip().split("\n\n"):
        head, wire, values = entry.split("\n")
        name, *header = head.split()
        numbers = {key: int(value) for key, value in (item.split("=") for item in header)}
        yield name, numbers, bytes.fromhex(wire), json.loads(values)


GOLDEN = list(golden())
NAMES = [entry[0] for entry in GOLDEN]


def from_the_page(name: str, header: dict[str, int], values: dict[str, Any]) -> bytes:
    """A frame made as the page's text says, with a textbook COBS."""
    code, _, rows = tables()[name]
    body = struct.pack("<BBHI", code, header["flags"], header["sequence"], header["device_us"])
    for offset, kind, shape, field, unit in rows:
        assert len(body) == 8 + offset
        numbers: list[Any] = [values[field]]
        for _ in shape:
            numbers = [item for group in numbers for item in group]
        lowest = -(2 ** (int(kind[3:]) - 1)) if kind.startswith("int") else None
        for number in numbers:
            whole = lowest if number is None else round(number * (PER_UNIT[unit] or 1))
            body += struct.pack("<" + LETTERS[kind], whole)
    body += struct.pack("<I", zlib.crc32(body))
    blocks = body.split(b"\0")
    return b"\0" + b"".join(bytes([len(block) + 1]) + block for block in blocks) + b"\0"


def plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    return None if isinstance(value, float) and math.isnan(value) else value


def test_the_tables_are_the_layouts() -> None:
    written = tables()
    assert set(written) == {code.name for code in Code}
    for kind, code in CODES.items():
        number, length, rows = written[code.name]
        assert (number, length) == (code, LENGTHS[code])
        assert [(row[3], row[2], PER_UNIT[row[4]]) for row in rows] == [
            (field.name, field.shape, field.per_unit) for field in LAYOUTS[kind].fields
        ]
        kinds = [
            ("u" if row[1][0] == "u" else "i") + str(int(re.sub(r"\D", "", row[1])) // 8) for row in rows
        ]
        assert kinds == [field.kind for field in LAYOUTS[kind].fields]


def test_the_flags_are_the_code_s() -> None:
    listed = re.findall(r"^\| ([\d, ]+) \| ([A-Z_, ]+) \|", PAGE, re.MULTILINE)
    written = {
        name: 1 << int(bit)
        for bits, names in listed
        for bit, name in zip(bits.split(","), names.split(", "), strict=True)
    }
    assert written == {flag.name: flag.value for flag in Flag if flag < 0x100}  # the others are the driver's


def test_why_heaters_are_off_is_the_code_s() -> None:
    text = PAGE.split("### 08 CONDITION")[1].split("\n## ")[0]
    for off in HeatersOff:
        assert off.name is not None and off.name in text
    assert HeatersOff.HOST_SILENT == 1 << int(re.findall(r"(\d) HOST_SILENT", text)[0])


@pytest.mark.parametrize(("name", "header", "wire", "values"), GOLDEN, ids=NAMES)
def test_a_golden_frame(name: str, header: dict[str, int], wire: bytes, values: dict[str, Any]) -> None:
    assert from_the_page(name, header, values) == wire
    decoder = Decoder()
    (frame,) = decoder.feed(wire)
    assert frame[:4] == (Code[name], header["flags"], header["sequence"], header["device_us"])
    message = decode_message(frame.code, frame.payload)
    assert type(message) is MESSAGES[Code[name]]
    assert {key: plain(getattr(message, key)) for key in values} == values
    assert encode_frame(Frame(*frame[:4], encode_message(message))) == wire


def test_every_message_has_a_golden_frame() -> None:
    assert set(NAMES) == {code.name for code in Code}
