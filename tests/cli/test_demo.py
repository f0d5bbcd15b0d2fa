"""`thermograsp demo`, the quick one, without OpenGL; and the charts it draws."""

import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from thermograsp.cli import main
from thermograsp.errors import MissingDependencyError
from thermograsp.figures.curves import Curve, Mark, chart
from thermograsp.thermal import SEED_MATERIALS


class Links(HTMLParser):
    """Collects what a page would load, and whether its elements nest."""

    def __init__(self) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.loaded += [value or "" for name, value in attrs if name in ("src", "href", "xlink:href")]
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_the_quick_demo_without_opengl(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def no_opengl(*args: object, **keywords: object) -> None:
        raise MissingDependencyError("no OpenGL; apt-get install libegl1")

    monkeypatch.setattr("thermograsp.figures.film.Renderer", no_opengl)
    out = tmp_path / "new" / "demo"
    assert main(["demo", "--quick", "--out", str(out), "--json"]) == 0
    printed = capsys.readouterr()
    assert "apt-get install libegl1" in printed.err
    summary = json.loads(printed.out)
    runs = {(run["material"], run["mode"]): run for run in summary["runs"]}
    assert set(runs) == {(name, mode) for name in SEED_MATERIALS for mode in "TO"}
    for run in runs.values():
        assert run["success"]
        table = np.genfromtxt(run["csv"], delimiter=",", names=True)
        assert len(table) == 400
        assert table["temperature_drop_left_K"].max() == pytest.approx(
            run["peak_temperature_drop_K"], rel=1e-8
        )
    # In T mode metals over stone over plastics over cotton, as their effusivities are.
    groups = (("cotton",), ("wood", "plastic", "rubber"), ("glass", "ceramic", "marble"))
    groups += (("stainless_steel",), ("iron",), ("aluminium",))
    drops = [[runs[name, "T"]["final_temperature_drop_K"] for name in group] for group in groups]
    for lower, higher in zip(drops, drops[1:], strict=False):
        assert max(lower) < min(higher)
    page = (out / "index.html").read_text(encoding="utf-8")
    links = Links()
    links.feed(page)
    assert links.loaded == [] and links.open == [] and "url(" not in page
    pressed, warm = page.count('class="press"'), page.count('aria-label="Temperature over')
    assert page.count("<svg") == 2 + pressed + warm and page.count('class="curve') == 20
    assert pressed >= 4 and warm >= 4
    assert "No pictures" in page and "apt-get install libegl1" in page
    assert len(list(out.iterdir())) == 21


def test_a_wrong_mujoco_gl_costs_the_pictures_only() -> None:
    command = [sys.executable, "-m", "thermograsp", "rollout", "thermograsp/Grasp-v0", "--episodes", "1"]
    done = subprocess.run(
        [*command, "--max-steps", "3"],
        env={**os.environ, "MUJOCO_GL": "nonsense"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0
    assert done.stderr.count("\n") == 1 and "MUJOCO_GL=nonsense" in done.stderr


def test_a_chart_follows_its_data_and_keeps_labels_apart() -> None:
    x = np.linspace(0.0, 10.0, 500)
    heights = (1.0, 1.01, 1.02, 3.0)
    curves = [Curve(f"<{i}>", f"m{i}", x, top * (1 - np.exp(-x))) for i, top in enumerate(heights)]
    svg = chart(curves, [Mark(1.0, "touch", before=True)], 10.0, 4.0, "A & B")
    root = ElementTree.fromstring(svg)
    groups = [group for group in root.iter("g")]
    assert [group.findtext("text") for group in groups] == ["<0>", "<1>", "<2>", "<3>"]
    places = [float(text.get("y", "nan")) for group in groups for text in group.iter("text")]
    assert min(abs(a - b) for i, a in enumerate(places) for b in places[:i]) > 14
    for curve, group in zip(curves, groups, strict=True):
        path = next(group.iter("path")).get("d", "")
        points = np.array([[float(part) for part in point.split()] for point in re.split("[ML]", path)[1:]])
        assert len(points) < len(x)
        drawn = np.interp(34 + (560 - 34 - 112) * x / 10, points[:, 0], points[:, 1])
        wanted = 26 + (400 - 26 - 36) * (1 - curve.y / 4)
        # 0.2 pixels are left out and coordinates are written to 0.1
        steepness = np.abs(np.gradient(wanted)).max() / np.gradient(34 + 41.4 * x).min()
        np.testing.assert_allclose(drawn, wanted, atol=0.2 + 0.05 + 0.05 * steepness)
