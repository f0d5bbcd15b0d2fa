"""The page's two curves can be told apart by everybody, and stand out from the paper."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest

CSS = (Path(__file__).parents[2] / "studio" / "web" / "page" / "studio.css").read_text(encoding="utf-8")
# At full severity, linear RGB: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A physiologically-based model for
# simulation of color vision deficiency", IEEE TVCG 15(6), 1291-1298 (2009), table 1.
SIGHTS = {
    "usual": np.eye(3),
    "protanopia": np.array(
        [(0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)]
    ),
    "deuteranopia": np.array(
        [(0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)]
    ),
    "tritanopia": np.array(
        [(1.255528, -0.076749, -0.178779), (-0.078411, 0.930809, 0.147602), (0.004733, 0.691367, 0.303900)]
    ),
}
TO_XYZ = np.array([(0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505)])  # sRGB, D65


def linear(hex_: str) -> np.ndarray:
    srgb = np.array([int(hex_[at : at + 2], 16) / 255 for at in (1, 3, 5)])
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def lab(rgb: np.ndarray) -> np.ndarray:
    """CIELAB under D65."""
    xyz = TO_XYZ @ np.clip(rgb, 0, 1) / (TO_XYZ @ np.ones(3))
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def schemes() -> list[dict[str, str]]:
    found = [
        dict(re.findall(r"--([\w-]+): (#\w{6})", block))
        for block in re.findall(r":root \{(.*?)\}", CSS, re.DOTALL)
    ]
    assert len(found) == 2  # light and dark
    return found


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("scheme", schemes(), ids=["light", "dark"])
def test_the_curves_differ_to_every_eye(scheme: dict[str, str], sight: str) -> None:
    seen = [lab(SIGHTS[sight] @ linear(scheme[name])) for name in ("first", "second", "paper")]
    for one, other in itertools.combinations(seen, 2):
        assert np.linalg.norm(one - other) > 25  # CIE76; 2.3 is just noticeable


@pytest.mark.parametrize("scheme", schemes(), ids=["light", "dark"])
def test_contrasts_are_those_of_wcag(scheme: dict[str, str]) -> None:
    """WCAG 2.1: 4.5 for text, 3 for graphics."""

    def contrast(one: str, other: str) -> float:
        dark, light = sorted(float(TO_XYZ[1] @ linear(scheme[name])) for name in (one, other))
        return (light + 0.05) / (dark + 0.05)

    for paper in ("paper", "card"):
        assert contrast("ink", paper) > 4.5 and contrast("soft", paper) > 4.5
        assert contrast("first", paper) > 3 and contrast("second", paper) > 3
