"""`thermograsp reproduce`: the paper's statements against numbers known by other means."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from thermograsp import thermal
from thermograsp.assets import asset
from thermograsp.cli import main
from thermograsp.reports.paper.claims import FINDINGS
from thermograsp.reports.paper.sweeps import MATERIALS
from thermograsp.reports.paper.theory import (
    exact_drop,
    printed_equation_1,
    printed_equation_2,
)

KEYS = {
    "equation_2",
    "equation_1",
    "erfc",
    "large_voltage",
    "first_flux_o",
    "first_flux_t",
    "top_face_o",
    "bottom_face_t",
    "field_moves",
    "penetration",
    "alike_at_first_o",
    "peaks_o_small",
    "peaks_o_similar",
    "peaks_o_large",
    "apart_at_once_t",
    "peaks_t",
    "clearer_peaks_t",
    "flat_end",
    "peak_time",
    "ordered_end",
    "small_effusivity_o",
    "small_effusivity_t",
    "measured_order",
    "measured_o",
    "measured_t",
    "slower_experiment",
    "later_end",
    "quicker_mode",
    "accordance",
    "widest_at_4_s",
    "tells_apart",
}


def test_every_statement_has_one_function_that_computes_it() -> None:
    statements = tomllib.loads(asset("paper.toml").read_text(encoding="utf-8"))
    assert set(statements) == set(FINDINGS) == KEYS
    assert all(set(words) == {"section", "statement"} for words in statements.values())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("reproduction") / "new"


@pytest.fixture(scope="module")
def document(folder: Path) -> dict:
    """The JSON of one quick run."""
    capture = pytest.MonkeyPatch()
    written: list[str] = []
    capture.setattr("builtins.print", lambda *text, **_: written.append(" ".join(map(str, text))))
    try:
        status = main(["reproduce", "--quick", "--json", "--out", str(folder)])
    finally:
        capture.undo()
    assert status == 0
    return json.loads("\n".join(written))


@pytest.fixture(scope="module")
def numbers(document: dict) -> dict[str, dict]:
    return {claim["key"]: claim["numbers"] for claim in document["claims"]}


def test_every_statement_is_there_with_a_verdict(document: dict) -> None:
    claims = document["claims"]
    assert {claim["key"] for claim in claims} == KEYS and len(claims) == len(KEYS)
    for claim in claims:
        assert claim["verdict"] in ("holds", "partly", "fails", "open")
        assert claim["section"] and claim["statement"].endswith(".") and claim["computed"].endswith(".")
        assert claim["verdict"] == "open" or claim["numbers"]
        assert "nan" not in claim["computed"].lower()
    assert sum(document["verdicts"].values()) == len(claims)


def test_figures_are_written(document: dict, folder: Path) -> None:
    names = {f"figure_{n}.{kind}" for n in ("3", "5", "6", "6_bands") for kind in ("svg", "png")}
    assert {Path(file).name for file in document["figures"]} == names
    for name in names:
        content = (folder / name).read_bytes()
        assert len(content) > 10_000
        assert content.startswith(b"\x89PNG" if name.endswith("png") else b"<?xml")
    assert "stainless steel" in (folder / "figure_5.svg").read_text(encoding="utf-8")
    assert (folder / "claims.txt").read_text(encoding="utf-8").count("->") == len(KEYS)


def test_figures_do_not_change_from_run_to_run(folder: Path, document: dict, tmp_path: Path) -> None:
    """Same numbers, same bytes: a figure in version control changes only with its content."""
    assert main(["reproduce", "--quick", "--json", "--out", str(tmp_path)]) == 0
    for name in ("figure_5.svg", "figure_6.svg", "figure_5.png"):
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes()


def test_falls_behind_the_peak_in_o_mode(numbers: dict) -> None:
    """Known from a three-dimensional finite-volume model made before this code."""
    falls = numbers["peaks_o_small"]["fall_by_8_s"]
    fall = {str(name): float(value) for name, value in zip(MATERIALS, falls, strict=True)}
    known = {"wood": 0.72, "plastic": 0.67, "glass": 0.46, "stainless_steel": 0.065, "aluminium": 0.009}
    for name, part in known.items():
        assert fall[name] == pytest.approx(part, abs=0.006), name
    assert fall["cotton"] > fall["wood"]


def test_peaks_in_t_mode(numbers: dict) -> None:
    times = np.array(numbers["peaks_t"]["peak_times_s"])
    assert 2.6 < times.min() and times.max() < 5.0
    assert numbers["peak_time"]["turns"] >= 2
    assert 6.0 < numbers["ordered_end"]["swap_s"] < 7.0
    assert (np.diff(numbers["clearer_peaks_t"]["peak_K"]) > 0).all()


def test_curves_meet_the_semi_analytic_reference(numbers: dict) -> None:
    """Drops at 20 s of the published reference table, K."""
    table = json.loads((Path(__file__).parents[1] / "data" / "press_3d.json").read_text(encoding="utf-8"))
    compared = 0
    for case, curve in table["cases"].items():
        name, conductance, mode = case.split("/")
        if name in MATERIALS and float(conductance) == 1e4 and curve["t"][-1] == 20:
            final = numbers["ordered_end"][f"final_{mode}_K"][MATERIALS.index(name)]
            assert final == pytest.approx(curve["Td"][-1], abs=0.01), case
            compared += 1
    assert compared >= 5


def test_alike_in_o_mode_before_half_a_second_only(numbers: dict) -> None:
    alike = numbers["alike_at_first_o"]
    assert alike["spread_at_0.5_s"] < 0.03 and 0.5 < alike["alike_until_s"] < 1.0
    assert alike["spread_at_2_s"] > 0.3


def test_the_difference_moves_into_the_object(numbers: dict) -> None:
    """In the element, the contact and the object together lie the whole 12 K."""
    moves = numbers["field_moves"]
    for mode in "OT":
        inside = np.array(moves[f"share_in_object_{mode}"])
        element = np.array(moves[f"share_in_element_{mode}"])
        assert (np.diff(inside) < 0).all() and (np.diff(element) > 0).all()
        assert ((inside + element) < 1).all() and ((inside + element) > 0.85).all()


def test_the_experiment_is_judged_on_every_rig(document: dict, folder: Path) -> None:
    """Plastic and rubber swap in O mode whatever the rig; a gap that is wide enough makes every experiment slow."""
    found = {claim["key"]: claim["support"] for claim in document["claims"] if claim["support"]}
    assert set(found) == {"measured_order", "measured_o", "measured_t", "slower_experiment", "later_end"}
    rigs = document["bands"]["rigs"]
    assert all(sum(support["counts"].values()) == rigs for support in found.values())
    assert found["measured_order"]["counts"] == {"holds": 0, "partly": rigs, "fails": 0}
    assert found["slower_experiment"]["counts"]["holds"] > 0.8 * rigs
    name, deciding_value, elsewhere = found["slower_experiment"]["deciding"]
    assert name == "roughness" and deciding_value > elsewhere
    text = (folder / "claims.txt").read_text(encoding="utf-8")
    assert text.count(f"Of the {rigs} rigs drawn the statement") == len(found)


def test_bands_hold_the_assumed_rig(document: dict, numbers: dict) -> None:
    bands = document["bands"]["drop_K"]
    assert len(bands) == 2 * 3 * len(MATERIALS)
    for band in bands:
        assert 0 < band["low"] < band["high"] < 15
        if band["t_s"] == 20:
            row = MATERIALS.index(band["material"])
            assert band["low"] < numbers["measured_order"][f"final_{band['mode']}_K"][row] < band["high"]


def test_a_gap_makes_every_curve_slower(numbers: dict) -> None:
    rise = numbers["slower_experiment"]
    for mode in "OT":
        slower = np.array(rise[f"rise_rough_{mode}_s"]) - np.array(rise[f"rise_smooth_{mode}_s"])
        assert (slower[1:] > 0.02).all()
        assert slower[0] > (-0.1 if mode == "T" else 0.02), (
            "cotton itself, not its contact, limits it in T mode"
        )


@pytest.mark.parametrize("gamma", [-0.9, -0.3, 0.5, 0.95])
def test_printed_equations(gamma: float) -> None:
    fourier = np.array([0.05, 0.5, 3.0])
    np.testing.assert_allclose(
        printed_equation_2(fourier, gamma), exact_drop("T", fourier, gamma), atol=1e-10
    )
    wrong = np.abs(printed_equation_1(fourier, gamma) - exact_drop("O", fourier, gamma))
    assert wrong.max() > 0.04


def test_rough_contact_is_the_worse_one() -> None:
    from thermograsp.reports.paper.sweeps import SMOOTH, rough_conductances

    for mode in ("O", "T"):
        rough = rough_conductances(mode)
        assert rough.shape == (10,) and (rough > 500).all() and (rough < SMOOTH / 2).all()


def test_materials_are_in_the_order_of_effusivity() -> None:
    values = [thermal.material(name).effusivity for name in MATERIALS]
    assert values == sorted(values)


def test_a_folder_that_is_a_file_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    taken = tmp_path / "taken"
    taken.write_text("x", encoding="utf-8")
    assert main(["reproduce", "--out", str(taken)]) == 2
    assert "not a folder" in capsys.readouterr().err
