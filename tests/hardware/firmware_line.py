"""A simulated board under a driver, and what it sent."""

from thermograsp.hardware import Fingertips, Samples, VirtualLine
from thermograsp.hardware.protocol.decoder import Decoder
from thermograsp.hardware.protocol.frame import Frame, encode_frame
from thermograsp.hardware.protocol.messages import (
    Code,
    Message,
    code_of,
    decode_message,
    encode_message,
)

from .board import Board


def driven(board: Board, **keywords: object) -> tuple[Fingertips, VirtualLine[Board]]:
    line = VirtualLine(board)
    return Fingertips(line.open, clock=line.clock, background=False, **keywords), line  # pyright: ignore[reportArgumentType]


def after(tips: Fingertips, line: VirtualLine[Board], seconds: float) -> Samples:
    """The samples of the next `seconds`."""
    tips.take()
    line.advance(seconds)
    return tips.take()


def attended(tips: Fingertips, line: VirtualLine[Board], seconds: float) -> Samples:
    """The samples of the last second, taken every second, as a host does that is there."""
    for _ in range(round(seconds) - 1):
        line.advance(1.0)
        tips.take()
    line.advance(1.0)
    return tips.take()


def sent(board: Board, code: Code) -> list[Message]:
    """All messages of a kind that it has ever sent."""
    frames = Decoder().feed(bytes(board.wire))
    return [decode_message(frame.code, frame.payload) for frame in frames if frame.code == code]


def ask(board: Board, message: Message, number: int) -> list[Frame]:
    """What it sends within 50 ms of a command, without a driver."""
    decoder = Decoder()
    board.receive(encode_frame(Frame(code_of(message), 0, number, 0, encode_message(message))))
    board.advance(board.now + 0.05)
    return decoder.feed(b"".join(board.outgoing()))
