"""The serial plant on devices that a simulation moves in real time: what the simulated plant gives, within the stated
latency, by the environments and by the command line."""

import json
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import thermograsp  # noqa: F401  (registers the environments)
from thermograsp.agents.scripted import ScriptedGrasp
from thermograsp.cli import main
from thermograsp.envs.plant.simulated import simulated_plant
from thermograsp.errors import InvalidValueError
from thermograsp.hardware import (
    Feel,
    Fingertips,
    GripperModel,
    PtyDevice,
    RobotiqGripper,
)
from thermograsp.hardware.drivers.gripper import Contact
from thermograsp.twin.beside import best_delay
from thermograsp.twin.simulated_hand import SimulatedHand

from .serving import COMING, nothing_left

pytest.importorskip("serial")

LATENCY = 0.04  # s, as docs/hardware.md states it
NOISE = 6e-5  # V, six standard deviations of the converter's noise and its steps
SEED = 5


class Timed(SimulatedHand):
    """It notes by how much its own line is late, which this machine decides and not the plant."""

    served: PtyDevice | None = None
    lag = 0.0

    def _feel(self, now: float) -> Feel:
        if self.served is not None:
            self.lag = max(self.lag, self.served.now - now)
        return super()._feel(now)


@contextmanager
def on_ports(folder: Path, hand: SimulatedHand) -> Iterator[str]:
    with (
        PtyDevice(hand.fingertips, folder / "tips") as tips,
        PtyDevice(hand.gripper, folder / "gripper") as gripper,
    ):
        if isinstance(hand, Timed):
            hand.served = tips
        yield f"serial://{tips.path}?gripper=robotiq://{gripper.path}"


def episode(env: gymnasium.Env[Any, Any], policy: ScriptedGrasp, steps: int) -> tuple[np.ndarray, ...]:
    """Times (n,) s, voltages (n, 2) V and openings (n,) m, whatever the plant."""
    observation, info = env.reset(seed=SEED)
    times, volts, openings, now = [], [], [], 0.0
    for _ in range(steps):
        action = policy.action({name: part[None] for name, part in observation.items()})[0]
        observation, *_, info = env.step(action)
        assert "error" not in info
        late = info.get("late", 0.0)
        now += 0.02 + (late if late > 1e-3 else 0.0)
        times += [now - 0.01, now]
        volts.append(observation["voltage"][:, -2:].T)
        openings.append(observation["gripper"][0])
    return np.array(times), np.concatenate(volts).astype(float), np.array(openings, float)


def test_the_same_policy_feels_the_same_on_either_plant(tmp_path: Path) -> None:
    hand = Timed(simulated_plant("simulated", 1, material="glass"), SEED, GripperModel(activation_speed=1.0))
    simulated = gymnasium.make("thermograsp/Grasp-v0", material="glass")
    t, expected, _ = episode(simulated, ScriptedGrasp(1, 0.02, 20.0), 90)
    simulated.close()
    with nothing_left(), on_ports(tmp_path, hand) as url:
        env = gymnasium.make("thermograsp/Grasp-v0", plant=url, disable_env_checker=True)
        measured_at, measured, openings = episode(env, ScriptedGrasp(1, 0.02, 20.0), 60)
        late = env.unwrapped.batch.plant.counts.latest  # pyright: ignore[reportAttributeAccessIssue]
        env.close()
    assert hand.episodes == 1
    assert openings[-1] == pytest.approx(0.04, abs=1e-3)
    assert measured.max() > 2e-3  # V: the object was felt
    window = LATENCY + late + hand.lag
    for now, volts in zip(measured_at, measured, strict=True):
        near = expected[(t > now - window) & (t < now + window)]
        assert len(near)
        assert (volts > near.min(axis=0) - NOISE).all() and (volts < near.max(axis=0) + NOISE).all()


def test_a_gripper_that_closes_on_a_simulated_object_says_so(tmp_path: Path) -> None:
    hand = SimulatedHand(
        simulated_plant("simulated", 1, material="wood"), 0, GripperModel(activation_speed=1.0)
    )
    with on_ports(tmp_path, hand), RobotiqGripper(str(tmp_path / "gripper")) as gripper:
        gripper.activate()
        with Fingertips(str(tmp_path / "tips"), rate=100) as tips:
            tips.wait(5, COMING)
            gripper.move(0.0, 20.0, 0.1)
            status = gripper.wait()
            assert status.contact is Contact.CLOSING and status.opening == pytest.approx(0.04, abs=2e-3)
            tips.take()  # the fingers stand a few samples before the force is all there
            assert tips.wait(10, COMING).force[-1, :, 0] == pytest.approx(20.0, abs=0.5)
            gripper.move(0.085, 0.0, 0.1)
            assert gripper.wait().contact is Contact.NONE
            tips.wait(5, COMING)
            assert hand.episodes == 2  # a fresh object


def test_a_hand_is_one_gripper() -> None:
    with pytest.raises(InvalidValueError, match="the simulation has 2"):
        SimulatedHand(simulated_plant("simulated", 2, material="wood"))


@pytest.mark.slow
def test_the_page_s_grasp_beside_a_simulation(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The two commands of docs/hardware.md, with shorter times."""
    page = (Path(__file__).parents[2] / "docs" / "hardware.md").read_text(encoding="utf-8")
    lines = re.search(
        r"^    thermograsp (device emulate-hand .*)\n    thermograsp (grasp --plant .*)$", page, re.MULTILINE
    )
    assert lines
    emulate, grasp = (
        shlex.split(line.replace("/tmp/", f"{tmp_path}/").rstrip("&")) for line in lines.groups()
    )
    files = {word: str(tmp_path / word) for word in ("beside.csv", "beside.svg")}
    grasp = [files.get(word, word) for word in grasp]
    with subprocess.Popen(
        [sys.executable, "-m", "thermograsp", *emulate, "--seconds", "60"], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert "robotiq://" in process.stdout.readline()
        assert main([*grasp, "--seconds", "1.5", "--hold", "0.5", "--json"]) == 0
        summary = json.loads(capsys.readouterr().out)
        process.terminate()
    assert summary["held"] and summary["error"] == "" and summary["steps"] == 75
    assert abs(summary["delay_s"]) < LATENCY + summary["latest_s"] + 0.05
    assert summary["difference_V"] < 2e-4
    table = np.genfromtxt(files["beside.csv"], delimiter=",", names=True)
    assert len(table) == 150 and (np.diff(table["time_s"]) > 0).all()
    assert table["voltage_left_V"].max() > 1e-3 and table["simulated_voltage_left_V"].max() > 1e-3
    assert "simulated" in Path(files["beside.svg"]).read_text()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--plant simulated", "--plant takes serial://"),
        ("--plant serial:///x?gripper=robotiq:///y --render a.gif", "use --plot"),
        ("--plot a.svg", "give --plant"),
        ("--plant serial:///nowhere/x?gripper=robotiq:///nowhere/y", "no such port"),
    ],
)
def test_a_grasp_that_cannot_be(words: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grasp", *words.split()]) == 2
    assert said in capsys.readouterr().err


def test_a_hand_that_cannot_be_emulated(capsys: pytest.CaptureFixture[str]) -> None:
    for words, said in (
        ("--seed -1", "seed must be"),
        ("--material glas", "'glass'"),
        ("--sensor a.toml", "cannot read"),
    ):
        assert main(["device", "emulate-hand", *words.split()]) == 2
        assert said in capsys.readouterr().err


def test_a_delay_is_found_where_something_was_felt() -> None:
    time = np.arange(1, 301) * 0.01
    rise = 4e-3 * np.clip(time - 0.5, 0, 1)
    late = 4e-3 * np.clip(time - 0.53, 0, 1)
    columns = {"time_s": time}
    for side in ("left", "right"):
        columns |= {f"voltage_{side}_V": late, f"simulated_voltage_{side}_V": rise}
    delay, difference = best_delay(columns)
    assert delay == pytest.approx(0.03, abs=1.5e-3) and difference < 1e-5
    flat = {name: values if name == "time_s" else np.zeros(300) for name, values in columns.items()}
    assert np.isnan(best_delay(flat)).all()
