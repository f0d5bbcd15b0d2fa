import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from thermograsp.envs.bodies.object_spec import ObjectSpec
from thermograsp.envs.gym import GraspBatch
from thermograsp.envs.mechanics.batch import Mechanics
from thermograsp.envs.pictures import render, temperatures
from thermograsp.envs.pictures.colormap import temperature_colour
from thermograsp.envs.pictures.render import Renderer, Window
from thermograsp.envs.tasks import SortTask
from thermograsp.errors import InvalidValueError, MissingDependencyError, UnknownNameError

ROOT = Path(__file__).parents[3]


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

    monkeypatch.setattr("thermograsp.opengl._context", broken)
    with pytest.raises(MissingDependencyError, match="apt-get install") as raised:
        Renderer(mechanics)
    packages = re.search(r"apt-get install ((lib[\w-]+ )+)", str(raised.value))
    assert packages is not None
    for name in ("README.md", "docs/start.md", "Dockerfile"):
        assert packages[1].strip() in (ROOT / name).read_text()
    assert set(packages[1].split()) <= set(re.findall(r"lib[\w-]+", (ROOT / ".ci" / "run").read_text()))


def test_a_window_needs_a_display(mechanics, monkeypatch):
    monkeypatch.setattr(render, "has_display", lambda: False)
    with pytest.raises(MissingDependencyError, match="rgb_array"):
        Window(mechanics)


def test_colours_grow_lighter_with_the_temperature():
    lightness = oklab(temperature_colour(np.linspace(20.0, 40.0, 256)))[:, 0]
    assert (np.diff(lightness) > 0).all()
    assert lightness[0] > 0.2, "a cold body is no black hole"


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
    """B. Ottosson, "A perceptual color space for image processing", 2020."""
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return np.cbrt(linear @ np.array(TO_LMS).T) @ np.array(TO_LAB).T


def test_temperatures_beyond_the_range_show_the_end_colours():
    low, mid, high = temperature_colour(np.array([10.0, 30.0, 50.0]))
    assert np.array_equal(low, temperature_colour(20.0)) and np.array_equal(high, temperature_colour(40.0))
    assert low.sum() < mid.sum() < high.sum()
    with pytest.raises(InvalidValueError, match="finite"):
        temperature_colour(float("nan"))


@pytest.mark.slow
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


@pytest.mark.parametrize(
    ("keywords", "names"),
    [
        ({"objects": ObjectSpec(name="mug"), "mode": "T"}, ("mug",)),
        ({"objects": ObjectSpec(name="mug"), "mode": "O"}, ("mug",)),
        ({"scene": [ObjectSpec(name="mug"), ObjectSpec(name="mug", position=(0.0, 0.06))]}, ("mug", "mug_1")),
        ({"plant": "simulated-pair", "objects": ObjectSpec(name="mug")}, ("mug_0", "mug_1")),
    ],
)
def test_every_object_has_its_own_colour_whatever_its_name(keywords, names):
    batch = GraspBatch(
        1, material=["glass", "wood"], task=SortTask() if "plant" in keywords else None, **keywords
    )
    batch.reset([0], [np.random.default_rng(0)])
    mechanics, reading = batch.plant.mechanics, batch.reading  # pyright: ignore[reportAttributeAccessIssue]
    assert reading is not None
    if len(names) > 1:
        warm = {"object_temperatures": np.array([[20.0, 40.0]])}
        reading = reading._replace(truth={**reading.truth, **warm})
    celsius = temperatures(reading, mechanics.names)
    assert [celsius[name] for name in names] == ([20.0, 40.0] if len(names) > 1 else [24.0])
    stage = render._Stage(mechanics, 20.0, 40.0)
    stage.load(mechanics, 0, celsius)
    for name in names:
        colour = stage.model.geom(f"{name}_0").rgba[:3]
        np.testing.assert_allclose(colour, temperature_colour(celsius[name]), atol=1e-6)


def test_meshes_of_one_file_name_are_two(tmp_path):
    import trimesh

    shapes = []
    for folder, side in (("a", 0.03), ("b", 0.04)):
        (tmp_path / folder).mkdir()
        trimesh.creation.box((side, side, side)).export(tmp_path / folder / "thing.stl")
        shapes.append(ObjectSpec(shape="mesh", mesh=str(tmp_path / folder / "thing.stl"), name=folder))
    finer = ObjectSpec(shape="mesh", mesh=shapes[0].mesh, scale=1.0000001, name="c")
    made = Mechanics((*shapes, finer), 1)
    widths = [2 * made.model.geom_aabb[made.model.geom(f"{name}_0").id, 3] for name in "abc"]
    np.testing.assert_allclose(widths, [0.03, 0.04, 0.03], rtol=1e-5)
