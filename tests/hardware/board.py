"""The firmware on its simulated board: built on demand, and served like any emulated device."""

import ctypes
import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest

FIRMWARE = Path(__file__).parents[2] / "hardware" / "firmware"
_NEEDED = "gcc gcc-avr avr-libc binutils-avr libsimavr-dev libelf-dev make"
_STEP = 0.0005  # s; how often the line looks for bytes


class Signals(ctypes.Structure):
    """What surrounds the processor, see board.c."""

    _fields_ = [
        ("voltage", ctypes.c_double * 2),
        ("force", ctypes.c_double * 6),
        ("heat", ctypes.c_double * 2),
        ("ambient", ctypes.c_double),
        ("supply", ctypes.c_double),
        ("heat_capacity", ctypes.c_double),
        ("loss", ctypes.c_double),
        ("lag", ctypes.c_double),
        ("noise", ctypes.c_double),
        ("conversion", ctypes.c_double),
        ("plate", ctypes.c_double * 2),
        ("thermistor", ctypes.c_double * 2),
        ("power", ctypes.c_double * 2),
        ("open", ctypes.c_int32 * 2),
        ("deaf", ctypes.c_int32 * 2),
        ("loose", ctypes.c_int32 * 2),
        ("cold", ctypes.c_int32 * 2),
        ("fuses", ctypes.c_int32),
    ]


def require_tools() -> None:
    """Skips the test where the firmware cannot be built or simulated."""
    tools = [name for name in ("cc", "avr-gcc", "make") if shutil.which(name) is None]
    headers = [
        path for path in ("/usr/include/simavr/sim_avr.h", "/usr/include/libelf.h") if not Path(path).exists()
    ]
    if tools or headers:
        pytest.skip(f"no {', '.join(tools + headers)}: on Debian, apt-get install {_NEEDED}")


@cache
def build(folder: Path, define: str = "") -> tuple[Path, str]:
    """The folder with firmware.elf and board.so, and what make said."""
    done = subprocess.run(
        ["make", "-C", str(FIRMWARE), f"OUT={folder}", f"DEFINE={define}", "all", "board"],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return folder, done.stdout


def library(folder: Path) -> ctypes.CDLL:
    lib = ctypes.CDLL(str(folder / "board.so"))
    pointer = ctypes.POINTER(Signals)
    lib.board_new.restype, lib.board_new.argtypes = pointer, [ctypes.c_char_p]
    lib.board_run.restype, lib.board_run.argtypes = ctypes.c_int, [pointer, ctypes.c_double]
    lib.board_time.restype, lib.board_time.argtypes = ctypes.c_double, [pointer]
    lib.board_give.argtypes = [pointer, ctypes.c_char_p, ctypes.c_uint32]
    lib.board_take.restype, lib.board_take.argtypes = (
        ctypes.c_uint32,
        [pointer, ctypes.c_char_p, ctypes.c_uint32],
    )
    lib.board_memory.restype, lib.board_memory.argtypes = ctypes.c_uint8, [pointer, ctypes.c_uint16]
    lib.board_free.argtypes, lib.board_reset.argtypes = [pointer], [pointer, ctypes.c_int]
    lib.board_stored.restype, lib.board_stored.argtypes = ctypes.c_uint8, [pointer, ctypes.c_uint16]
    lib.board_store.argtypes = [pointer, ctypes.c_uint16, ctypes.c_uint8]
    return lib


class Receiver(ctypes.Structure):
    """Of frame.h, for this machine's compiler."""

    _fields_ = [
        ("bytes", ctypes.c_uint8 * 65),
        ("length", ctypes.c_uint8),
        ("overlong", ctypes.c_bool),
        ("bad", ctypes.c_uint16),
    ]


class Controller(ctypes.Structure):
    """Of thermostat.h."""

    _fields_ = [
        ("setpoint", ctypes.c_float),
        ("measured", ctypes.c_float),
        ("previous", ctypes.c_float),
        ("integral", ctypes.c_float),
        ("power", ctypes.c_float),
        ("on", ctypes.c_bool),
    ]


def portable(folder: Path) -> ctypes.CDLL:
    """The firmware's parts without hardware, for this machine."""
    lib = ctypes.CDLL(str(folder / "board.so"))
    lib.crc32.restype, lib.crc32.argtypes = ctypes.c_uint32, [ctypes.c_char_p, ctypes.c_uint8]
    lib.cobs_encode.argtypes = [ctypes.c_char_p, ctypes.c_uint8, ctypes.c_char_p]
    lib.receive.restype, lib.receive.argtypes = ctypes.c_uint8, [ctypes.POINTER(Receiver), ctypes.c_uint8]
    lib.thermostat_step.restype = ctypes.c_float
    lib.thermostat_step.argtypes = [ctypes.POINTER(Controller), ctypes.c_float, ctypes.c_bool]
    lib.thermistor_temperature.restype, lib.thermistor_temperature.argtypes = ctypes.c_float, [ctypes.c_float]
    lib.thermistor_broken.restype, lib.thermistor_broken.argtypes = ctypes.c_bool, [ctypes.c_float]
    return lib


class Board:
    """An Emulated device: the processor runs as far as time goes on."""

    def __init__(self, folder: Path) -> None:
        self._lib = library(folder)
        self._board = self._lib.board_new(str(folder / "firmware.elf").encode())
        assert self._board
        self._room = ctypes.create_string_buffer(1 << 16)
        self.wire = bytearray()  # all that it has sent

    @property
    def signals(self) -> Signals:
        return self._board.contents

    @property
    def now(self) -> float:
        return self._lib.board_time(self._board)

    @property
    def due(self) -> float:
        return self.now + _STEP

    def advance(self, now: float) -> None:
        assert self._lib.board_run(self._board, now) == 0, "the processor has stopped"

    def receive(self, data: bytes) -> None:
        self._lib.board_give(self._board, data, len(data))

    def outgoing(self) -> list[bytes]:
        count = self._lib.board_take(self._board, self._room, len(self._room))
        data = ctypes.string_at(self._room, count)
        self.wire += data
        return [data] if data else []

    def memory(self, address: int) -> int:
        return self._lib.board_memory(self._board, address)

    def stored(self, address: int) -> int:
        """A byte of the EEPROM."""
        return self._lib.board_stored(self._board, address)

    def store(self, address: int, value: int) -> None:
        self._lib.board_store(self._board, address, value)

    def reset(self, cause: int = 0x02) -> None:
        """cause: bits of MCUSR, the reset line's where not given."""
        self._lib.board_reset(self._board, cause)

    def close(self) -> None:
        self._lib.board_free(self._board)
