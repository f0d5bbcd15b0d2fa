"""The server, who may talk to it, and a process for each visitor."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.studio.web.access import Access
    from thermograsp.studio.web.server import Studio

__all__ = [
    "Access",
    "Studio",
]

__getattr__ = opened(__name__)
