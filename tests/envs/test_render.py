import shutil
import subprocess
import sys

import numpy as np
import pytest

from thermograsp.envs import render
from thermograsp.envs.colormap import colour_table, oklab_path, srgb_from_oklab, temperature_colour
from thermograsp.envs.mechanics import Mechanics
from thermograsp.envs.render import Renderer, Window
from thermograsp.envs.scene import ObjectSpec
from thermograsp.errors import InvalidValueError, MissingDependencyError, UnknownNameError


@pytest.fixture(scope="module")
def mechanics():
    return Mechanics((ObjectSpec(),), 2)


@pytest.fixture(scope="module")
def renderer(mechanics):
    try:
        made = Renderer(mechanics, width=160, height=120, shadows=False)
    except MissingDependencyError as error:
        pytest.skip(str(error))
    with made:
        yield made


def test_both_cameras_see_different_things(renderer):
    assert len(renderer.cameras) >= 2
    frames = [renderer.frame(camera=name) for name in renderer.cameras]
    for frame in frames:
        assert frame.shape == (120, 160, 3) and frame.dtype == np.uint8
        assert frame.std() > 10
    assert np.abs(frames[0].astype(int) - frames[1]).mean() > 10


def test_the_sky_is_above_the_table(renderer):
    frame = renderer.frame().astype(int)
    blueness = frame[..., 2] - frame[..., 0]
    assert blueness[:10].mean() > blueness[-30:].mean()


def test_temperature_shows_on_object_and_sensor(renderer):
    plain = renderer.frame(camera="closeup").astype(int)
    for name in ("object", "sensor_left", "thermostat_right"):
        cold, hot = (
            renderer.frame(camera="closeup", temperatures={name: t}).astype(int) for t in (20.0, 40.0)
        )
        changed = np.abs(hot - cold).sum(axis=-1) > 30
        assert changed.any()
        assert hot[changed].mean() > cold[changed].mean() + 30
    assert np.array_equal(renderer.frame(camera="closeup"), plain)  # colours last one frame


def test_environments_are_drawn_as_they_are(mechanics, renderer):
    mechanics.reset(objects=[(ObjectSpec(),), (ObjectSpec(shape="sphere"),)])
    first, second = renderer.frame(0), renderer.frame(1)
    assert not np.array_equal(first, second)
    mechanics.reset([1], height=0.1)
    assert not np.array_equal(renderer.frame(1), second)
    assert np.array_equal(renderer.frame(0), first)


def test_unknown_names_are_suggested(renderer):
    with pytest.raises(UnknownNameError, match="overview"):
        renderer.frame(camera="overviev")
    with pytest.raises(UnknownNameError, match="sensor_left"):
        renderer.frame(temperatures={"sensor_lef": 30.0})


def test_sizes_and_ranges_are_checked(mechanics):
    with pytest.raises(InvalidValueError, match="2000 x 10"):
        Renderer(mechanics, width=2000, height=10)
    with pytest.raises(InvalidValueError, match="low < high"):
        Renderer(mechanics, low=40.0, high=20.0)


def test_missing_opengl_names_the_packages(mechanics, monkeypatch):
    def broken(width, height):
        raise OSError("libEGL.so.1 not found")

    monkeypatch.setattr(render, "_gl_context", broken)
    with pytest.raises(MissingDependencyError, match="libegl1 libegl-mesa0 libgl1-mesa-dri"):
        Renderer(mechanics)


def test_a_window_needs_a_display(mechanics, monkeypatch):
    monkeypatch.setattr(render, "_has_display", lambda: False)
    with pytest.raises(MissingDependencyError, match="rgb_array"):
        Window(mechanics)


def test_colours_are_perceptually_uniform():
    path = oklab_path(4096)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    lightness = np.interp(np.linspace(0, along[-1], 256), along, path[:, 0])
    assert (np.diff(lightness) > 0).all()
    # Nothing is cut off at the gamut's edge, which would bend the spacing.
    assert np.abs(oklab(srgb_from_oklab(path)) - path).max() < 2e-3
    steps = np.linalg.norm(np.diff(oklab(colour_table()), axis=0), axis=1)
    assert steps.max() / steps.min() < 1.1


TO_LMS = [
    (0.4122214708, 0.5363325363, 0.0514459929),
    (0.2119034982, 0.6806995451, 0.1073969566),
    (0.0883024619, 0.2817188376, 0.6299787005),
]
TO_LAB = [
    (0.2104542553, 0.7936177850, -0.0040720468),
    (1.9779984951, -2.4285922050, 0.4505937099),
    (0.0259040371, 0.7827717662, -0.8086757660),
]


def oklab(srgb):
    """Forward transform with Ottosson's published matrices (the module has the inverse ones)."""
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return np.cbrt(linear @ np.array(TO_LMS).T) @ np.array(TO_LAB).T


def test_temperatures_beyond_the_range_show_the_end_colours():
    low, mid, high = temperature_colour(np.array([10.0, 30.0, 50.0]))
    assert np.array_equal(low, colour_table()[0]) and np.array_equal(high, colour_table()[-1])
    assert low.sum() < mid.sum() < high.sum()
    with pytest.raises(InvalidValueError, match="finite"):
        temperature_colour(float("nan"))


@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="needs xvfb-run, a screen for nobody")
def test_a_window_opens_follows_and_closes() -> None:
    program = (
        "import gymnasium, thermograsp\n"
        "from thermograsp.envs import action_of\n"
        "env = gymnasium.make('thermograsp/Grasp-v0', material='glass', render_mode='human')\n"
        "env.reset(seed=0)\n"
        "for _ in range(10):\n"
        "    env.step(action_of(0.0, 10.0, 0.0))\n"
        "assert env.unwrapped._renderer._window.open\n"
        "env.close()\n"
        "print('closed')\n"
    )
    screen = ["xvfb-run", "-a", "-s", "-screen 0 1024x768x24"]
    done = subprocess.run(
        [*screen, sys.executable, "-c", program], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0 and done.stdout.strip() == "closed", done.stderr
