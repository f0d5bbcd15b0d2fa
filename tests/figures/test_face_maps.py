"""The page's maps of temperature: every part is drawn, the wrist's side on top, cold dark and warm bright."""

import re
from xml.etree import ElementTree

import numpy as np

from thermograsp.figures.face_maps import Touch, face_section


def test_each_part_is_a_square_of_its_temperature() -> None:
    celsius = np.array([[24.0, 26.0, 28.0], [30.0, 30.0, 30.0]], np.float32)
    drawn = ElementTree.fromstring(face_section([Touch("bar", np.zeros((4, 4)), celsius)]))
    squares = [each.attrib for each in drawn.iter("rect") if "fill" in each.attrib]
    assert [(each["x"], each["y"]) for each in squares] == [
        (str(x), str(y)) for y in (0, 1) for x in (0, 1, 2)
    ]

    def lightness(colour: str) -> int:
        return sum(bytes.fromhex(colour[1:]))

    top, bottom = squares[:3], squares[3:]
    assert len({each["fill"] for each in top}) == 1
    colder = [lightness(each["fill"]) for each in bottom]
    assert sorted(colder) == colder and colder[-1] < lightness(top[0]["fill"])
    text = "".join(drawn.itertext())
    assert re.search(r"24\.0 to 30\.0 °C", text) and "bar" in text
