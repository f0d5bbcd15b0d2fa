"""`thermograsp grasp`: the recording is the environment's, and the exit status tells what happened."""

import json
from pathlib import Path

import gymnasium
import numpy as np
import pytest

from thermograsp.agents.recording import record
from thermograsp.cli import main
from thermograsp.envs import GraspBatch
from thermograsp.errors import MissingDependencyError

COLUMNS = """
time_s voltage_left_V voltage_right_V temperature_drop_left_K temperature_drop_right_K force_left_N force_right_N
contact_area_left_m2 contact_area_right_m2 conductance_left_W_m2K conductance_right_W_m2K
heat_flow_left_W heat_flow_right_W sensor_surface_left_degC sensor_surface_right_degC
object_surface_left_degC object_surface_right_degC object_temperature_degC opening_m height_m lift_m
""".split()


def test_a_grasp_is_lifted_held_and_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "aluminium.csv"
    line = f"grasp --material aluminium --seconds 4.5 --seed 3 --csv {file} --json"
    assert main(line.split()) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["success"] and summary["material"] == "aluminium" and 0.2 < summary["touch_time_s"] < 1.0
    table = np.genfromtxt(file, delimiter=",", names=True)
    assert list(table.dtype.names or ()) == COLUMNS
    np.testing.assert_allclose(table["time_s"], np.arange(1, 451) / 100, rtol=1e-8)
    assert np.isfinite(np.array(table.tolist())).all()
    before = table["time_s"] < summary["touch_time_s"] - 0.1  # the first fingertip touches a little earlier
    assert (table["temperature_drop_left_K"][before] == 0).all() and (
        table["force_left_N"][before] == 0
    ).all()
    late = table["time_s"] > 2.5
    assert (table["lift_m"][late] > 0.049).all() and (table["force_left_N"][late] > 5).all()
    # 1 mV/K, after an amplifier and a converter whose noise is far below 0.2 mV
    np.testing.assert_allclose(
        table["voltage_left_V"][late], 1e-3 * table["temperature_drop_left_K"][late], atol=2e-4
    )


def test_a_row_of_a_batch_is_the_grasp_alone() -> None:
    together = record(GraspBatch(2, material=["glass", "iron"]), [5, 9], 1.0, materials=["iron", "glass"])
    (alone,) = record(GraspBatch(1, material=["glass", "iron"]), [9], 1.0, materials=["glass"])
    assert [one.material for one in together] == ["iron", "glass"]
    for name, values in alone.columns.items():
        np.testing.assert_array_equal(together[1].columns[name], values)
    assert together[1].events == alone.events


def test_a_pad_around_the_sensor_cools_it_less(capsys: pytest.CaptureFixture[str]) -> None:
    drops = []
    for words in ("", " --surround silicone"):
        assert main(f"grasp --material stainless_steel --seconds 4.5 --seed 3 --json{words}".split()) == 0
        drops.append(json.loads(capsys.readouterr().out)["peak_temperature_drop_left_K"])
    assert 0.05 < drops[0] - drops[1] < 0.6


def test_a_weak_grip_is_a_failure(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("grasp --material iron --force 0.5 --seconds 4".split()) == 1
    assert "not lifted and held" in capsys.readouterr().out


def test_a_crushed_object_is_a_failure(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("grasp --material butter --force 40 --seconds 3 --json".split()) == 1
    summary = json.loads(capsys.readouterr().out)
    assert summary["ending"] == "crushed" and not summary["success"]


@pytest.mark.parametrize("shape", ["cylinder", "sphere"])
def test_other_shapes(shape: str, capsys: pytest.CaptureFixture[str]) -> None:
    line = f"grasp --shape {shape} --width 0.05 --material glass --seconds 4.5 --json"
    assert main(line.split()) == 0
    assert json.loads(capsys.readouterr().out)["final"]["contact_area_left_m2"] > 0


def test_a_picture_or_the_reason_why_there_is_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "grasp.gif"
    status = main(["grasp", "--seconds", "0.4", "--hold", "0.02", "--render", str(file)])
    if status == 2:
        assert "apt-get install" in capsys.readouterr().err
    else:
        assert file.read_bytes().startswith(b"GIF8")


def test_without_opengl_a_picture_is_refused_with_the_packages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def no_opengl(*args: object, **keywords: object) -> None:
        raise MissingDependencyError("no OpenGL; apt-get install libegl1")

    monkeypatch.setattr("thermograsp.figures.film.Renderer", no_opengl)
    assert main(["grasp", "--seconds", "1", "--render", str(tmp_path / "grasp.png")]) == 2
    assert "apt-get install" in capsys.readouterr().err


def test_the_recording_is_what_the_environment_gives() -> None:
    """The environment alone, under the actions that the script chose, gives the recorded voltages and drops."""
    (grasp,) = record(GraspBatch(1, material="glass"), [4], 1.5)
    env = gymnasium.make("thermograsp/Grasp-v0", material="glass")
    observation, _ = env.reset(seed=4)
    from thermograsp.agents.scripted import ScriptedGrasp

    policy, drops, volts = ScriptedGrasp(1, 0.02), [], []
    for _ in range(75):
        observation, *_, info = env.step(
            policy.action({name: part[None] for name, part in observation.items()})[0]
        )
        drops.append(info["temperature_drop"])
        volts.append(observation["voltage"][:, -2:].T)
    env.close()
    recorded = [grasp.columns[f"temperature_drop_{side}_K"] for side in ("left", "right")]
    np.testing.assert_array_equal(np.array(drops), np.stack(recorded, axis=1)[1::2])
    recorded = [grasp.columns[f"voltage_{side}_V"] for side in ("left", "right")]
    np.testing.assert_array_equal(np.concatenate(volts), np.stack(recorded, axis=1).astype(np.float32))
