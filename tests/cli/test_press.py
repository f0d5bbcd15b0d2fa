"""`thermograsp press`."""

import argparse
import inspect
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from thermograsp import thermal
from thermograsp.cli import main, press


def test_the_csv_is_the_press(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "glass.csv"
    line = f"press glass --mode O --conductance 2e3 --seconds 3 --tolerance 0.02 --csv {file} --json"
    assert main(line.split()) == 0
    summary = json.loads(capsys.readouterr().out)
    expected = thermal.press("glass", mode="O", conductance=2e3, seconds=3.0, tolerance=0.02)
    assert file.read_text().splitlines()[0] == (
        "time_s,temperature_drop_K,voltage_V,heat_flow_W,sensor_surface_degC,object_surface_degC,"
        "stored_heat_sensor_J,stored_heat_object_J"
    )
    table = np.genfromtxt(file, delimiter=",", names=True)
    assert len(table) == summary["samples"] == 151
    for name, values in (
        ("time_s", expected.t),
        ("temperature_drop_K", expected.temperature_drop),
        ("voltage_V", expected.voltage),
        ("stored_heat_object_J", expected.stored_heat[:, 1]),
    ):
        np.testing.assert_allclose(table[name], values, rtol=1e-8, atol=1e-12)
    assert summary["rung"]["error_K"] <= 0.02
    assert summary["peak_temperature_drop_K"] == max(expected.temperature_drop)


def test_a_second_fingertip_and_a_weak_thermostat(capsys: pytest.CaptureFixture[str]) -> None:
    finals = []
    for more in ("", "--opposite 1e4", "--thermostat-power 0.5"):
        assert main(f"press aluminium --object-size 0.03 0.03 0.01 {more} --json".split()) == 0
        finals.append(json.loads(capsys.readouterr().out)["final_temperature_drop_K"])
    assert finals[1] < finals[0] and finals[2] < finals[0]  # a warmer object, a cooler thermostat


@pytest.mark.parametrize("suffix", ["svg", "png"])
def test_a_plot(suffix: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / f"glass.{suffix}"
    assert main(["press", "glass", "--seconds", "2", "--plot", str(file)]) == 0
    start = {"svg": b"<?xml", "png": b"\x89PNG"}[suffix]
    assert file.read_bytes().startswith(start)
    out = capsys.readouterr().out
    assert "rung" in out and "peak" in out and str(file) in out


def test_an_asked_for_rung_has_no_measured_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["press", "glass", "--rung", "layered", "--seconds", "1", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["rung"] == {
        "name": "layered",
        "orders": "",
        "error_K": None,
        "reason": "asked for",
    }


def test_keywords_and_defaults_are_those_of_the_function() -> None:
    parser = argparse.ArgumentParser()
    press.add_arguments(parser)
    given = vars(parser.parse_args(["glass"]))
    wanted = {
        name: parameter.default
        for name, parameter in inspect.signature(thermal.press).parameters.items()
        if parameter.default is not parameter.empty
    }
    assert wanted.pop("cache") is True and given["no_cache"] is False
    assert wanted.pop("thermostat") is None and given["thermostat_power"] is None
    assert {name: given[name] for name in wanted} == wanted


def test_a_mesh_in_millimetres_is_the_plate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "plate.stl"
    trimesh.creation.box((40, 10, 40)).export(file)
    line = "press glass --seconds 3 --json --tolerance 0.03"
    assert main(f"{line} --mesh {file} --scale 0.001 --side front".split()) == 0
    mesh = json.loads(capsys.readouterr().out)
    assert main(line.split()) == 0
    plate = json.loads(capsys.readouterr().out)
    assert mesh["rung"]["name"] == "body"
    assert mesh["final_temperature_drop_K"] == pytest.approx(plate["final_temperature_drop_K"], abs=0.05)


@pytest.mark.parametrize("given", ["--scale 0.001", "--scale 1", "--side top", "--side front"])
def test_what_only_meshes_have_is_refused_without_one(given: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["press", "glass", *given.split()]) != 0
    assert f"{given.split()[0]} is for meshes: give --mesh FILE too" in capsys.readouterr().err


def test_a_mesh_that_cannot_be_pressed_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "plate.stl"
    trimesh.creation.box((40, 10, 40)).export(file)
    assert main(["press", "glass", "--mesh", str(file)]) != 0
    assert "multiply them by 0.001" in capsys.readouterr().err
    assert main(["press", "glass", "--mesh", str(file), "--scale", "0.001", "--mode", "O"]) != 0
    assert "--mode is for plates" in capsys.readouterr().err


def test_a_skin_is_felt_through(capsys: pytest.CaptureFixture[str]) -> None:
    finals = []
    for skin in ("", " --skin filled_silicone"):
        assert main(f"press aluminium --seconds 2 --json{skin}".split()) == 0
        finals.append(json.loads(capsys.readouterr().out)["final_temperature_drop_K"])
    assert 0.5 < finals[1] < finals[0]
