# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

import math
import pickle

import mujoco
import numpy as np
import pytest

from thermograsp.envs.bodies.object_spec import ObjectSpec
from thermograsp.envs.limits import MAX_OPENING, TIPS
from thermograsp.envs.mechanics.batch import Mechanics
from thermograsp.envs.mechanics.contact_record import ContactRecord
from thermograsp.errors import InvalidValueError

G = 9.81
FIELDS = ContactRecord.__dataclass_fields__


def run(mechanics, seconds, opening=0.0, force=10.0, lift=0.0):
    """Hold one command in every environment; the records joined along substeps."""
    n = mechanics.num_envs
    records = [
        mechanics.step(np.full(n, opening), np.full(n, force), np.full(n, lift))
        for _ in range(round(seconds / 0.02))
    ]
    assert not records[-1].failed.any(), mechanics.failure
    return {
        name: np.concatenate([getattr(r, name) for r in records], axis=1)
        for name in FIELDS
        if name != "failed"
    }


def grasp_and_lift(*specs, force=10.0):
    mechanics = Mechanics((specs[0],), len(specs))
    mechanics.reset(objects=[(spec,) for spec in specs])
    run(mechanics, 1.2, force=force)
    run(mechanics, 0.5, force=force, lift=0.05)
    run(mechanics, 0.5, force=force)
    return mechanics


def test_held_objects_do_not_slip():
    shapes = ("box", "cylinder", "sphere")
    mechanics = grasp_and_lift(*(ObjectSpec(shape=shape) for shape in shapes))
    held = run(mechanics, 10.0)
    moved = held["object_pose"][:, -1, 0, :3] - held["object_pose"][:, 0, 0, :3]
    assert held["height"][:, -1] == pytest.approx(0.025, abs=1e-3)
    assert np.linalg.norm(moved, axis=-1).max() < 1e-4


def test_what_the_friction_cannot_hold_falls():
    limit = 2 * 0.8 * 2.0 / G  # kg, both fingers' friction cone at 2 N
    mechanics = grasp_and_lift(ObjectSpec(mass=0.8 * limit), ObjectSpec(mass=1.2 * limit), force=2.0)
    lifted = mechanics.object_pose[:, 0, 2] - 0.02
    assert lifted[0] == pytest.approx(0.025, abs=1e-3)
    assert lifted[1] < 1e-3


@pytest.mark.parametrize("force", [2.0, 10.0, 40.0])
def test_the_force_is_the_commanded_one_and_steady(force):
    mechanics = grasp_and_lift(
        *(ObjectSpec(shape=shape) for shape in ("box", "cylinder", "sphere")), force=force
    )
    normal = run(mechanics, 1.0, force=force)["force"][:, :, :, 0, 0]
    assert normal == pytest.approx(force, rel=0.01)
    assert (normal.std(axis=1) < 0.01 * force).all()


@pytest.mark.parametrize("size", [(0.006, 0.03, 0.03), (0.08, 0.04, 0.04)])
def test_thin_and_wide_objects_get_the_full_force(size):
    mechanics = Mechanics((ObjectSpec(size=size),))
    run(mechanics, 1.8, force=40.0)
    assert run(mechanics, 0.1, force=40.0)["force"][..., 0] == pytest.approx(40.0, rel=0.01)


@pytest.mark.parametrize("force", [5.0, 20.0, 40.0])
def test_touching_down_makes_no_large_impact(force):
    normal = run(Mechanics((ObjectSpec(),)), 1.2, force=force)["force"][..., 0]
    assert normal.max() < force + 1.0


def test_the_approach_is_bounded_and_exact_in_free_air():
    mechanics = Mechanics((ObjectSpec(size=(0.01, 0.01, 0.02), position=(0.0, 0.09)),))
    for target in (0.03, 0.06, 0.0, MAX_OPENING):
        moved = run(mechanics, 1.5, opening=target, force=20.0)
        assert np.abs(moved["opening_rate"]).max() < 0.11
        assert moved["opening"][0, -1] == pytest.approx(target, abs=1e-6)
        assert not moved["touching"].any()


def test_a_wider_target_releases_the_object():
    mechanics = grasp_and_lift(ObjectSpec())
    run(mechanics, 0.5, opening=MAX_OPENING)
    after = run(mechanics, 0.2, opening=MAX_OPENING)
    assert not after["touching"].any() and not after["force"].any() and not after["centroid"].any()
    assert after["object_pose"][0, -1, 0, 2] == pytest.approx(0.02, abs=1e-4)


def test_the_lift_follows_its_rate_holds_and_stops_at_its_ends():
    mechanics = Mechanics((ObjectSpec(mass=0.3),))
    run(mechanics, 1.2, force=20.0)
    up = run(mechanics, 1.0, force=20.0, lift=0.04)["height"][0]
    assert (up[-1] - up[-101]) / 0.2 == pytest.approx(0.04, rel=1e-3)
    held = run(mechanics, 1.0, force=20.0)["height"][0]
    assert np.ptp(held[-250:]) < 1e-5
    assert run(mechanics, 4.0, force=20.0, lift=0.05)["height"][0, -1] == pytest.approx(0.15, abs=5e-4)
    assert run(mechanics, 4.0, force=20.0, lift=-0.05)["height"][0, -1] == pytest.approx(0.0, abs=5e-4)


def test_signs_in_the_pads_frames():
    mass = 0.2
    mechanics = grasp_and_lift(ObjectSpec(mass=mass))
    force = run(mechanics, 0.2)["force"][0, -1, :, 0]
    assert (force[:, 0] > 0).all()  # pressing
    assert force[:, 2] == pytest.approx(mass * G / 2, rel=0.02)  # each tip carries half the weight, upwards
    assert force[:, 1] == pytest.approx(0.0, abs=1e-6)


def test_centroid_is_where_the_object_touches():
    """A ball that sits aside is felt on that side of either pad, one that sits low is felt low."""
    aside = ObjectSpec(shape="sphere", position=(0.0, 0.003))
    low = ObjectSpec(shape="sphere", size=(0.014, 0.014, 0.014))  # its middle is 7 mm high, the pad's 12 mm
    mechanics = Mechanics((aside,), 2)
    mechanics.reset(objects=[(aside,), (low,)])
    centroid = run(mechanics, 1.5, force=2.0)["centroid"][:, -1, :, 0]
    left, right = centroid[0, :, 0]
    assert left == pytest.approx(0.003, abs=1e-3) and right == pytest.approx(-0.003, abs=1e-3)
    assert centroid[1, :, 1] == pytest.approx(-0.005, abs=1e-3)


@pytest.mark.parametrize("degrees", [3.0, 5.0])
def test_a_turned_box_still_meets_the_whole_pad(degrees):
    mechanics = Mechanics((ObjectSpec(yaw=math.radians(degrees)),))
    run(mechanics, 1.2)
    record = run(mechanics, 0.2)
    model, data = mechanics.env_model(0), mechanics.env_data(0)
    mujoco.mj_forward(model, data)
    for k, tip in enumerate(TIPS):
        body, pad = model.body(f"tip_{tip}").id, data.site(f"pad_{tip}")
        found = [c.pos for c in data.contact if body in model.geom_bodyid[c.geom]]
        corners = {tuple(np.sign(pad.xmat.reshape(3, 3).T @ (p - pad.xpos))[1:]) for p in found}
        assert len(found) == 4 and len(corners) == 4
        assert np.abs(record["centroid"][0, -1, k, 0]).max() < 0.0025
    left, right = record["force"][0, -1, :, 0, 0]
    assert left == pytest.approx(right, rel=1e-3)
    assert left == pytest.approx(10.0, rel=0.02)


def test_net_force_is_the_sum_over_contacts():
    spec = ObjectSpec(shape="cylinder", yaw=0.03, mass=0.3)
    mechanics = grasp_and_lift(spec)
    model, data = mechanics.env_model(0), mechanics.env_data(0)
    n = 1
    before = mechanics.state()
    record = mechanics.step(np.zeros(n), np.full(n, 10.0), np.full(n, 0.02), substeps=1)
    mechanics.env_model(0, model)
    sim = mujoco.MjData(model)
    mujoco.mj_setState(model, sim, before.rows[0], mujoco.mjtState.mjSTATE_INTEGRATION)
    sim.ctrl[:] = mechanics.env_data(0, data).ctrl
    mujoco.mj_step(model, sim)
    target = model.body("object").id
    for k, tip in enumerate(TIPS):
        body = model.body(f"tip_{tip}").id
        total, moment = np.zeros(3), np.zeros(3)
        for i, contact in enumerate(sim.contact):
            pair = model.geom_bodyid[contact.geom]
            if set(pair) != {body, target}:
                continue
            wrench = np.zeros(6)
            mujoco.mj_contactForce(model, sim, i, wrench)
            sign = 1.0 if pair[1] == target else -1.0  # MuJoCo's force acts on the second geom
            total += sign * wrench[:3] @ contact.frame.reshape(3, 3)
            moment += np.linalg.norm(wrench[:3]) * contact.pos
        axes = sim.site(f"pad_{tip}").xmat.reshape(3, 3)
        assert record.force[0, 0, k, 0] == pytest.approx(axes.T @ total, abs=1e-9)
        assert total @ axes[:, 0] > 5.0


def random_commands(rng, steps, n):
    return [
        (rng.uniform(0, 0.085, n), rng.uniform(0, 40, n), rng.uniform(-0.05, 0.05, n))
        if k % 10 == 0
        else (np.zeros(n), np.full(n, 15.0), rng.uniform(-0.05, 0.05, n))
        for k in range(steps)
    ]


def mixed_objects(rng, n):
    def one(i):
        d = float(rng.uniform(0.02, 0.06))
        shape = ("box", "cylinder", "sphere")[i % 3]
        return ObjectSpec(
            shape=shape, size=(d, d, d), density=float(rng.uniform(200, 3000)), friction=float(rng.uniform(0.3, 1.0)),
            position=(float(rng.uniform(-0.003, 0.003)), 0.0), yaw=float(rng.uniform(-0.05, 0.05)),
        )  # fmt: skip

    return [(one(i),) for i in range(n)]


def test_a_batch_is_bit_identical_to_single_environments_at_any_thread_count():
    rng = np.random.default_rng(1)
    size, steps = 8, 60
    objects, commands = mixed_objects(rng, size), random_commands(rng, steps, size)

    def rollout(chosen, threads):
        mechanics = Mechanics(objects[chosen[0]], len(chosen), threads=threads)
        mechanics.reset(objects=[objects[i] for i in chosen])
        return [mechanics.step(o[chosen], f[chosen], r[chosen]) for o, f, r in commands]

    whole = rollout(list(range(size)), 1)
    assert any(r.touching.any() for r in whole)
    others = [(list(range(size)), 2), ([0, 3, 5], 1), ([2, 6, 7], 2)] + [([i], 1) for i in range(size)]
    for chosen, threads in others:
        for one, all_ in zip(rollout(chosen, threads), whole, strict=True):
            for name in FIELDS:
                assert np.array_equal(getattr(one, name), getattr(all_, name)[chosen]), (
                    name,
                    chosen,
                    threads,
                )


def test_a_restored_state_repeats_the_future_exactly():
    rng = np.random.default_rng(2)
    objects, commands = mixed_objects(rng, 3), random_commands(rng, 90, 3)
    mechanics = Mechanics(objects[0], 3)
    mechanics.reset(objects=objects)
    for command in commands[:40]:
        mechanics.step(*command)
    saved = pickle.loads(pickle.dumps(mechanics.state()))
    first = [mechanics.step(*c) for c in commands[40:]]
    mechanics.set_state(saved)
    again = [mechanics.step(*c) for c in commands[40:]]
    other = Mechanics((ObjectSpec(),), 3)  # another batch, which held other objects
    other.set_state(saved)
    elsewhere = [other.step(*c) for c in commands[40:]]
    for a, b, c in zip(first, again, elsewhere, strict=True):
        for name in FIELDS:
            assert np.array_equal(getattr(a, name), getattr(b, name)), name
            assert np.array_equal(getattr(a, name), getattr(c, name)), name


def test_one_environment_is_restored_or_reset_without_touching_the_others():
    objects = mixed_objects(np.random.default_rng(3), 3)
    commands = random_commands(np.random.default_rng(4), 60, 3)

    def play(meddle):
        mechanics = Mechanics(objects[0], 3)
        mechanics.reset(objects=objects)
        records = [mechanics.step(*command) for command in commands[:30]]
        saved = mechanics.state([1])
        if meddle:
            mechanics.reset([1], [objects[2]])
        records += [mechanics.step(*command) for command in commands[30:40]]
        if meddle:
            mechanics.set_state(saved, [1])
        records += [mechanics.step(*command) for command in commands[40:]]
        return records[-1]

    runs = play(False), play(True)
    for name in FIELDS:
        plain, meddled = (getattr(r, name) for r in runs)
        assert np.array_equal(plain[[0, 2]], meddled[[0, 2]]), name


def test_a_broken_simulation_is_flagged_until_it_is_reset(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its warning to a log file here
    mechanics = Mechanics((ObjectSpec(),), 3)
    state = mechanics.state([1])
    state.rows[0, 5] = np.nan
    mechanics.set_state(state, [1])
    command = np.zeros(3), np.full(3, 10.0), np.zeros(3)
    record = mechanics.step(*command)
    assert record.failed.tolist() == [False, True, False]
    assert "BADQ" in mechanics.failure[1]
    assert np.isfinite(record.opening[[0, 2]]).all()
    assert mechanics.step(*command).failed.tolist() == [False, True, False]
    mechanics.reset([1])
    assert not mechanics.step(*command).failed.any()


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (([0.09, 0.0], [1.0, 1.0], [0.0, 0.0]), "opening 0.09 in environment 0"),
        (([0.0, 0.0], [1.0, float("nan")], [0.0, 0.0]), "force_limit nan in environment 1"),
        (([0.0, 0.0], [1.0, 1.0], [0.0, -0.06]), "lift_rate -0.06"),
        (([0.0], [1.0, 1.0], [0.0, 0.0]), r"shape \(1,\)"),
    ],
)
def test_bad_commands_are_refused(command, message):
    with pytest.raises(InvalidValueError, match=message):
        Mechanics((ObjectSpec(),), 2).step(*command)


def test_bad_ids_and_objects_are_refused():
    mechanics = Mechanics((ObjectSpec(),), 2)
    with pytest.raises(InvalidValueError, match="0 to 1"):
        mechanics.reset([2])
    with pytest.raises(InvalidValueError, match="names and number"):
        mechanics.reset([0], [(ObjectSpec("cup"),)])
    with pytest.raises(InvalidValueError, match="ids name 2"):
        mechanics.reset(objects=[(ObjectSpec(),)])


def test_two_objects_are_told_apart():
    left = ObjectSpec("left_half", size=(0.02, 0.03, 0.04), position=(-0.0105, 0.0))
    right = ObjectSpec("right_half", size=(0.02, 0.03, 0.04), position=(0.0105, 0.0))
    mechanics = Mechanics((left, right))
    touching = run(mechanics, 1.5)["touching"][0, -1]
    assert touching.tolist() == [[True, False], [False, True]]
