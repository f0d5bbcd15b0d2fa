"""The figure of an identification."""

from matplotlib.figure import Figure

from thermograsp import thermal
from thermograsp.figures.identify_plot import title
from thermograsp.figures.look import style


def test_its_title_is_no_wider_than_the_figure() -> None:
    """Also that of six materials with the longest names."""
    names = sorted(thermal.materials(), key=len)[-6:]
    with style():
        figure = Figure(figsize=(11.5, 3.9), layout="constrained")
        title(
            figure,
            f"it is one of 90 materials: {', '.join(names)} ...; its effusivity is 1353 W s^0.5/(m2 K)",
        )
        figure.draw_without_rendering()
    assert figure.texts[0].get_window_extent().x1 <= figure.bbox.x1
    assert figure.get_suptitle().endswith("\nits effusivity is 1353 W s^0.5/(m2 K)")
