"""`thermograsp view`: what it refuses, and films without a browser."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from thermograsp.cli import main
from thermograsp.envs.bodies.object_spec import ObjectSpec
from thermograsp.envs.mechanics.batch import Mechanics
from thermograsp.envs.pictures.render import Renderer
from thermograsp.errors import MissingDependencyError


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--port 70000", "port must be 0 to 65535"),
        ("--visitors 0", "visitors must be at least 1"),
        ("--material glas", "did you mean 'glass'"),
        ("--material glass wood cotton", "1 to 2 names"),
        ("--mode X", "unknown mode"),
        ("--recording x.csv --plant serial:///dev/null", "exclude each other"),
        ("--plant robotiq:///dev/null", "--plant takes serial:"),
        ("--render x.mp4", "must end with"),
        ("--render x.gif --seconds 61", "60 s at most"),
        ("--recording nosuch.csv", "cannot read nosuch.csv"),
        ("--policy nosuch.npz", "no file nosuch.npz"),
        ("--render x.gif --recording y.csv", "leave --recording and --plant out"),
    ],
)
def test_what_it_refuses(
    words: str,
    message: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["view", *words.split()]) == 2
    assert message in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_film_of_two_grasps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        Renderer(Mechanics((ObjectSpec(),), 1), width=8, height=8).close()
    except MissingDependencyError as error:
        pytest.skip(str(error))
    film = tmp_path / "both.gif"
    words = ["view", "--material", "aluminium", "cotton", "--render", str(film), "--seconds", "1", "--json"]
    assert main(words) == 0
    assert json.loads(capsys.readouterr().out)["materials"] == ["aluminium", "cotton"]
    with Image.open(film) as pictures:
        assert getattr(pictures, "n_frames") == 10  # noqa: B009
        first = np.asarray(pictures.convert("RGB")).astype(int)
        pictures.seek(9)
        last = np.asarray(pictures.convert("RGB")).astype(int)
    middle = first.shape[1] // 2
    for half in (slice(0, middle), slice(middle, None)):  # the grippers have closed
        assert np.abs(last[:, half] - first[:, half]).max() > 100
