"""Mode O on small objects: all of an element lies on the object, or the object is refused."""

import pytest

from thermograsp.envs import GraspBatch, ObjectSpec, Size
from thermograsp.errors import InvalidValueError

ELEMENT = (0.009, 0.0035)  # m, side and thickness


@pytest.mark.parametrize("height", [0.0165, 0.02, 0.024, 0.04, 0.12])
def test_an_element_lies_on_the_object(height: float) -> None:
    spec = ObjectSpec(size=(0.03, 0.009, height), elements=ELEMENT)
    middles = spec.element_places[:, 2] + height / 2  # over the table
    assert (middles - ELEMENT[0] / 2 >= 0).all()
    assert (middles + ELEMENT[0] / 2 <= height + 1e-12).all()


@pytest.mark.parametrize(
    ("size", "message"),
    [
        ((0.03, 0.03, 0.0075), r"7\.5 mm high.* make it 16\.5 mm at least"),
        ((0.03, 0.03, 0.0164), r"16\.4 mm high.* make it 16\.5 mm at least"),
        ((0.03, 0.03, 0.01649), r"16\.49 mm high"),
        ((0.03, 0.0089, 0.03), r"8\.9 mm deep along y.* make it 9 mm at least"),
    ],
)
def test_where_it_would_stick_out_it_is_refused(size: tuple[float, float, float], message: str) -> None:
    """It was felt as if all of it lay on the object."""
    with pytest.raises(InvalidValueError, match=message):
        ObjectSpec(size=size, elements=ELEMENT)
    ObjectSpec(size=size)


@pytest.mark.parametrize("objects", ["dice", "eraser", ObjectSpec(size=(0.03, 0.03, 0.016))])
def test_an_object_that_is_too_low_is_refused_when_the_environment_is_made(objects: str | ObjectSpec) -> None:
    with pytest.raises(InvalidValueError, match=r"16\.5 mm at least, or use mode T"):
        GraspBatch(1, mode="O", material="glass", objects=objects)
    GraspBatch(1, material="glass", objects=objects)


def test_so_is_one_that_may_be_drawn_too_low() -> None:
    with pytest.raises(InvalidValueError, match=r"14\.4 mm high"):
        GraspBatch(
            1,
            mode="O",
            material="glass",
            objects=ObjectSpec(size=(0.03, 0.03, 0.018)),
            randomize=[Size((0.8, 1.1))],
        )
