"""A device's times on the host's clock: the line under the delays of its messages."""

from __future__ import annotations

from collections import deque

_BUCKET = 0.25  # s of device time, of which the promptest message counts
_KEPT = 240  # buckets: one minute
_SHORTEST = 0.5  # s; below that the drift is taken as none

Point = tuple[float, float]


class ClockFit:
    """host = device + offset + drift x device, from messages that arrive with a delay of 0 or more.

    The fit is the line that no delay lies under and that is the closest to all: the edge of the lower convex hull
    under their mean time (S. Moon, P. Skelly & D. Towsley, "Estimation and removal of clock skew from network delay
    measurements", INFOCOM 1999). Late messages, however many, do not move it. What the promptest message of the last
    minute took on its way is not seen: it counts to the offset. Times in s; drift relative.
    """

    def __init__(self) -> None:
        self._points: deque[Point] = deque(maxlen=_KEPT)
        self._best: Point | None = None
        self._bucket = 0
        self._at = 0.0
        self._offset = 0.0
        self.drift = 0.0

    def add(self, device: float, host: float) -> None:
        """A message of that device time, come at that host time. Device times do not fall much."""
        delay = host - device
        bucket = int(device // _BUCKET)
        if self._best is None:
            self._bucket, self._at, self._offset = bucket, device, delay
        elif bucket != self._bucket:
            self._points.append(self._best)
            self._bucket, self._best = bucket, None
            self._fit()
        if self._best is None or delay < self._best[1]:
            self._best = (device, delay)
            if not self._points:
                self._at, self._offset = self._best

    def host_time(self, device: float) -> float:
        """Host time of a device time, s."""
        return device + self._offset + self.drift * (device - self._at)

    @property
    def offset(self) -> float:
        """s, host time of device time 0."""
        return self.host_time(0.0)

    def _fit(self) -> None:
        points = self._points
        if points[-1][0] - points[0][0] < _SHORTEST:
            self._at, self._offset = min(points, key=lambda point: point[1])
            return
        middle = sum(device for device, _ in points) / len(points)
        hull = _lower_hull(points)
        right = next(i for i in range(1, len(hull)) if hull[i][0] >= middle or i == len(hull) - 1)
        (x0, y0), (x1, y1) = hull[right - 1], hull[right]
        self._at, self._offset, self.drift = x0, y0, (y1 - y0) / (x1 - x0)


def _lower_hull(points: deque[Point]) -> list[Point]:
    """Corners of the lower convex hull of points whose x rises."""
    hull: list[Point] = []
    for point in points:
        if hull and point[0] <= hull[-1][0]:
            continue
        while len(hull) > 1 and _left_of(hull[-2], hull[-1], point) <= 0:
            hull.pop()
        hull.append(point)
    return hull


def _left_of(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
