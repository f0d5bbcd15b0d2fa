"""One visitor's session: its clock, its log and its picture."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.studio.session.record import record_studio
    from thermograsp.studio.session.session import Session

__all__ = [
    "Session",
    "record_studio",
]

__getattr__ = opened(__name__)
