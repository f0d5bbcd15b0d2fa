"""`thermograsp device record`: every byte of the line into a file."""

from __future__ import annotations

import argparse
import time

from thermograsp.cli.shared import (
    Output,
    add_duration,
    add_port,
    add_sampling,
    connect,
    link_document,
    link_line,
    target,
)
from thermograsp.errors import InvalidValueError

HELP = "Record the raw bytes of the line until the time is over or Ctrl-C, for `thermograsp device replay`."

_PERIOD = 0.1  # s


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of the action."""
    add_port(parser)
    parser.add_argument("file", metavar="FILE", help="new file for the recording")
    add_sampling(parser)
    add_duration(parser)
    parser.add_argument("--note", default="", help="text to keep in the recording")


def run(args: argparse.Namespace) -> int:
    """Records and prints. 1 where frames were lost or the line was broken; the file has what came. Raises
    RecordingError where the disk is full."""
    from thermograsp import __version__
    from thermograsp.hardware import Recorder
    from thermograsp.hardware.errors import DeviceError

    file = target(args.file, ())
    if file is None:
        raise InvalidValueError("name the recording's file")
    output, seconds = Output(args.json), args.seconds
    metadata = {
        "port": args.port,
        "baud": args.baud,
        "rate_Hz": args.rate,
        "note": args.note,
        "version": __version__,
    }
    with Recorder(file, metadata) as recorder:
        try:
            tips = connect(args, recorder)
        except BaseException:
            recorder.close()
            file.unlink()
            raise
        broken = ""
        with tips, output.progress(seconds) as advance:
            begun = last = time.monotonic()
            try:
                while not recorder.failure and (seconds is None or last - begun < seconds):
                    time.sleep(min(_PERIOD, seconds or _PERIOD))
                    try:
                        tips.take()
                        broken = ""
                    except DeviceError as error:
                        if type(error).__name__ != broken:
                            output.warn(str(error))
                        broken = type(error).__name__
                    now = time.monotonic()
                    advance(f"recording, {tips.statistics().samples} samples", now - last)
                    last = now
            except KeyboardInterrupt:
                pass
            statistics = tips.statistics()
    output.line(link_line(statistics))
    output.line(f"wrote {file}")
    output.document(
        {"file": str(file), "bytes": recorder.bytes, "seconds": last - begun, **link_document(statistics)}
    )
    return 1 if broken or statistics.lost or statistics.reconnects or not statistics.samples else 0
