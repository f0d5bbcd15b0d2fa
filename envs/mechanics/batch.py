"""Batched gripper mechanics over mujoco.batch: commands in, contact forces at every substep out.

Shapes: B environments, S substeps, T = 2 fingertips (left, right), O objects.
Environment i's numbers do not depend on B or on the number of threads, to the last bit.
"""

# mujoco ships no type stubs for its compiled names
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from thermograsp.errors import InvalidValueError, whole_number

from ..bodies import ObjectSpec, placeless
from ..grippers import SHIPPED_GRIPPER, GripperModel
from ..limits import (
    LIFT_ACCELERATION,
    MAX_FORCE,
    MAX_HEIGHT,
    MAX_LATERAL_RATE,
    MAX_LIFT_RATE,
    MAX_OPENING,
    SUBSTEPS,
    TIPS,
)
from .contact_record import FULL_RECORD, ContactRecord, contact_record
from .engine import MODEL_FIELDS, Batch
from .kept_fields import KeptFields
from .kernel import (
    ADDRESSES,
    Motion,
    any_risen,
    set_points,
    summarise,
)
from .resized import Resized, primitive
from .scene import build_scene, contact_sensor
from .solver_settings import SHIPPED, SolverSettings

if TYPE_CHECKING:
    from .pad_contacts import PadContacts

_KEPT_MODELS = 512
_RANGES = (
    ("opening", 0.0, MAX_OPENING),
    ("force_limit", 0.0, MAX_FORCE),
    ("lift_rate", -MAX_LIFT_RATE, MAX_LIFT_RATE),
)
_RECORD: tuple = ("sensordata", "site_xmat")
# The families of model fields that objects decide; what depends on the gripper alone is left out for speed.
_FAMILIES = ("body_", "bvh_", "cam_", "dof_", "geom_", "light_", "qpos")
_MODEL_ARRAYS = tuple(sorted(name for name in MODEL_FIELDS if name.startswith(_FAMILIES)))


@dataclass(frozen=True, slots=True)
class MechanicsState:
    """Everything that determines the future of some environments' mechanics; picklable.

    rows (n, nstate): MuJoCo's integration states. force_limit (n,) N. objects: each environment's objects.
    failure: each environment's reason of failure, "" when it runs.
    """

    rows: np.ndarray
    force_limit: np.ndarray
    objects: tuple[tuple[ObjectSpec, ...], ...]
    failure: tuple[str, ...]


class Mechanics:
    """`num_envs` grippers, each over its own objects.

    objects: what every environment holds at first; later ones may differ in all but name and number. Meshes that
    come later must be in `library`. threads: 0 means all CPUs. settings: of MuJoCo. lateral: the arm slides along y.
    gripper: in place of the shipped one; it opens as wide and closes as hard as it can, whatever more is commanded.
    contacts: `pad_contacts` can be asked. model: the compiled model of the first objects (MjModel).

    The gripper's low-level law is in the model: a servo on the opening whose set point moves at a bounded
    rate and whose closing force saturates at the force limit, in every substep.
    """

    def __init__(
        self,
        objects: Sequence[ObjectSpec] = (ObjectSpec(),),
        num_envs: int = 1,
        *,
        threads: int = 1,
        library: Sequence[ObjectSpec] = (),
        settings: SolverSettings = SHIPPED,
        lateral: bool = False,
        gripper: GripperModel = SHIPPED_GRIPPER,
        contacts: bool = False,
    ) -> None:
        whole_number("num_envs", num_envs, 1)
        whole_number("threads", threads)
        self._library = tuple(library) + tuple(o for o in objects if o.mesh)
        self._settings, self._sideways, self.gripper = settings, lateral, gripper
        # Another gripper may do less than a command can say.
        self._weaker = gripper.widest < MAX_OPENING or gripper.strongest < MAX_FORCE
        self._recorded = (*_RECORD, "site_xpos") if contacts else _RECORD
        self._latest: dict[Any, np.ndarray] = {}
        self.num_envs = num_envs
        self.objects: list[tuple[ObjectSpec, ...]] = [tuple(objects)] * num_envs
        self.names = tuple(o.name for o in objects)
        # At the origin, so that two batches with the same objects share every model field.
        at_origin = tuple(placeless(o) for o in objects)
        self.model = self._build(at_origin)
        self._batch = Batch(self.model, num_envs, threads)
        self._rows = self._batch.state  # every simulation's mjSTATE_INTEGRATION, live
        self._qpos, self._qvel, self._act, self._ctrl = (
            self._batch.bind(name) for name in ("qpos", "qvel", "act", "ctrl")
        )
        self._force_range = self._batch.expand("actuator_forcerange")
        self._warning = self._batch.warning  # (B, kinds, 2) last and count, live
        self._warned = self._warning[:, :, 1].copy()
        self._live = (
            *(self._qpos, self._qvel, self._act, self._ctrl, self._force_range),
            *(self._warning, self._warned),
        )
        # Outputs are those of the last substep's beginning.
        self._moved = (
            self._batch.bind("site_xpos"),
            self._batch.bind("xpos"),
            self._batch.bind("xquat"),
            self._qpos,
            self._qvel,
        )
        self._out: dict[tuple[int, tuple], dict[Any, np.ndarray]] = {}
        self._compiled = KeptFields(_KEPT_MODELS)
        self._base = {name: getattr(self.model, name).tobytes() for name in _MODEL_ARRAYS}
        self._resized = Resized(self.model, self.names, gripper, self._base) if primitive(at_origin) else None
        self._expanded: dict[str, np.ndarray] = {}
        self._index(self.model)
        self.failure, self.failed = ("",) * num_envs, np.zeros(num_envs, bool)
        """Why each environment can't go on, "" where it can, and which can't. Replaced, never written to: readings keep
        them."""
        self.reset()

    def _build(self, objects: tuple[ObjectSpec, ...]) -> mujoco.MjModel:
        return build_scene(
            objects,
            library=self._library,
            settings=self._settings,
            lateral=self._sideways,
            gripper=self.gripper,
        )

    def _index(self, model: mujoco.MjModel) -> None:
        left, right = (model.joint(name) for name in self.gripper.joints)
        grip, lift = model.actuator("grip").id, model.actuator("lift").id
        # build_scene lays out free joints, pads and contact sensors in order, so that slices find them.
        free = [int(model.joint(f"{name}_free").qposadr[0]) for name in self.names]
        self._poses = slice(free[0], free[0] + 7 * len(free))
        sensors = [contact_sensor(tip, name) for tip in TIPS for name in self.names]
        assert free == list(range(free[0], self._poses.stop, 7)) and self._poses.stop == model.nq
        assert [model.site(i).name for i in range(model.nsite)] == [f"pad_{tip}" for tip in TIPS]
        assert [model.sensor(i).name for i in range(model.nsensor)] == sensors
        self._contacts = len(TIPS), len(self.names), model.nsensordata // len(sensors)
        places = {
            "left": left.qposadr[0],
            "right": right.qposadr[0],
            "left_dof": left.dofadr[0],
            "right_dof": right.dofadr[0],
            "height": model.joint("lift").qposadr[0],
            "grip": grip,
            "lift": lift,
            "grip_act": model.actuator_actadr[grip],
            "lift_act": model.actuator_actadr[lift],
            "poses": free[0],
            "body": 0,
            "sensor": self._contacts[2],
        }
        self._layout = np.zeros(len(free), ADDRESSES)
        for number, pose in enumerate(free):
            places.update(poses=pose, body=model.body(self.names[number]).id, object=number)
            self._layout[number] = tuple(places[name] for name in ADDRESSES.names or ())
        self._at: Any = self._layout.view(np.recarray)[0]
        self._lateral = (
            (model.joint("lateral").qposadr[0], model.actuator("lateral").id) if self._sideways else None
        )
        self._stiffness = -float(model.actuator_biasprm[grip, 1])

    @property
    def opening(self) -> np.ndarray:
        """(B,) m between the pads, now."""
        return self._qpos[:, self._at.left] + self._qpos[:, self._at.right]

    @property
    def height(self) -> np.ndarray:
        """(B,) m over the lowest position, now."""
        return self._qpos[:, self._at.height].copy()

    @property
    def lateral(self) -> np.ndarray:
        """(B,) m of the arm along y, now. Raises InvalidValueError without such an axis."""
        return self._qpos[:, self._along_y()[0]].copy()

    @property
    def object_pose(self) -> np.ndarray:
        """(B, O, 7) position in m and quaternion (w, x, y, z) of every object, world frame, now."""
        return self._qpos[:, self._poses].reshape(self.num_envs, -1, 7).copy()

    def reset(
        self,
        ids: Sequence[int] | np.ndarray | None = None,
        objects: Sequence[Sequence[ObjectSpec]] | None = None,
        *,
        height: float = 0.0,
    ) -> None:
        """Start environments anew, at rest: objects on the table, gripper as wide open as it goes, at `height` (m).

        ids: which (None: all). objects: for each of them its objects (None: as they were).
        Raises InvalidValueError when names or number of objects change or a mesh is not in the library.
        """
        rows = self._ids(ids)
        if objects is not None:
            if len(objects) != len(rows):
                raise InvalidValueError(f"objects for {len(objects)} environments, ids name {len(rows)}")
            chosen = [tuple(items) for items in objects]
            for items in chosen:
                self._check_layout(items)
            for i, items in zip(rows, chosen, strict=True):
                self._set_objects(int(i), items)
        within("height", np.array([height]), 0.0, MAX_HEIGHT)
        self._batch.reset(rows, stage=mujoco.mjtStage.mjSTAGE_NONE)
        opening = min(MAX_OPENING, self.gripper.widest)
        fingers, positions = self.gripper.rest(self.model, opening)
        for i in rows:
            self._qpos[i, fingers] = positions
            self._qpos[i, self._at.height] = height
            self._qpos[i, self._poses] = np.concatenate([item.pose for item in self.objects[i]])
            self._act[i, self._at.grip_act] = opening
            self._act[i, self._at.lift_act] = height
        self._note(dict.fromkeys(rows.tolist(), ""))

    def step(
        self, opening: np.ndarray, force_limit: np.ndarray, lift_rate: np.ndarray, substeps: int = SUBSTEPS
    ) -> ContactRecord:
        """Advance every environment by `substeps` with one command each, all (B,), and tell all of every substep.

        opening: m, target, 0 .. 0.085. force_limit: N, closing force on an object that blocks the fingers, 0 .. 40.
        lift_rate: m/s, -0.05 .. 0.05; the lift stops by itself at 0 and 0.15 m.
        Raises InvalidValueError for a shape, a non-finite value or one outside its range, naming it.
        """
        out = self._roll(opening, force_limit, lift_rate, substeps, FULL_RECORD)
        if any_risen(self._warning, self._warned):
            self._note_warned()
        return contact_record(out, self._contacts, self._poses, self._at, self.failed)

    def advance(
        self, opening: np.ndarray, force_limit: np.ndarray, lift_rate: np.ndarray, substeps: int = SUBSTEPS
    ) -> Motion:
        """The same step, with what heat and observations need of the first object, at a fraction of the cost. The
        arrays are the caller's own, without the axis O."""
        return self.advance_all(opening, force_limit, lift_rate, substeps).of(0)

    def advance_all(
        self, opening: np.ndarray, force_limit: np.ndarray, lift_rate: np.ndarray, substeps: int = SUBSTEPS
    ) -> Motion:
        """The same of all objects."""
        self._latest = out = self._roll(opening, force_limit, lift_rate, substeps, self._recorded)
        rows, objects, tips = self.num_envs, len(self.names), len(TIPS)
        motion = Motion(
            np.empty((rows, objects, substeps, tips)),
            np.empty((rows, objects, tips, 3)),
            np.empty((rows, objects, tips, 3)),
            np.empty(rows),
            np.empty(rows),
            np.empty(rows),
            np.empty((rows, objects)),
        )
        recorded = out["sensordata"], out["site_xmat"]
        if summarise(self._layout, *recorded, *self._moved, self._warning, self._warned, *motion):
            self._note_warned()
        return motion

    def slide(
        self,
        opening: np.ndarray,
        force_limit: np.ndarray,
        lift_rate: np.ndarray,
        lateral_rate: np.ndarray,
        substeps: int = SUBSTEPS,
    ) -> Motion:
        """The same of an arm that moves along y as well, lateral_rate (B,) m/s, -0.1 .. 0.1. Raises InvalidValueError
        without such an axis."""
        servo = self._along_y()[1]
        rate = self._batched("lateral_rate", lateral_rate)
        within("lateral_rate", rate, -MAX_LATERAL_RATE, MAX_LATERAL_RATE)
        change = LIFT_ACCELERATION * substeps * self._settings.timestep
        last = self._ctrl[:, servo]
        self._ctrl[:, servo] = np.clip(rate, last - change, last + change)
        return self.advance_all(opening, force_limit, lift_rate, substeps)

    def pad_contacts(self) -> tuple[PadContacts, ...]:
        """Where on the pads each object pressed in the last `advance` or `slide`. Needs contacts=True, and is to be
        asked before the next step."""
        from .pad_contacts import PadContacts, pad_contacts

        out, tips = self._latest, len(TIPS)
        found = []
        for number in range(len(self.names)):
            contacts = PadContacts(
                np.empty((self.num_envs, tips)),
                np.empty((self.num_envs, tips, 2)),
                np.empty((self.num_envs, tips, 4, 3)),
            )
            records = out["sensordata"], out["site_xpos"], out["site_xmat"]
            pad_contacts(self._layout[number : number + 1], *records, *self._moved[1:3], *contacts)
            found.append(contacts)
        return tuple(found)

    def _along_y(self) -> tuple[int, int]:
        """Where the arm's position is in qpos and its servo in ctrl."""
        if self._lateral is None:
            raise InvalidValueError("this arm has no axis along y: build Mechanics with lateral=True")
        return self._lateral

    def state(self, ids: Sequence[int] | np.ndarray | None = None) -> MechanicsState:
        """A copy of the state of some environments (None: all), for `set_state` here or in another batch."""
        rows = self._ids(ids)
        return MechanicsState(
            rows=self._rows[rows].copy(),
            force_limit=-self._force_range[rows, self._at.grip, 0],
            objects=tuple(self.objects[i] for i in rows),
            failure=tuple(self.failure[i] for i in rows),
        )

    def set_state(self, state: MechanicsState, ids: Sequence[int] | np.ndarray | None = None) -> None:
        """Put environments into a state; what follows is bit-identical to what followed it first.

        Raises InvalidValueError when the state has another number of environments or another layout.
        """
        rows = self._ids(ids)
        if state.rows.shape != (len(rows), self._rows.shape[1]):
            raise InvalidValueError(
                f"state of shape {state.rows.shape} for {len(rows)} environments of {self._rows.shape[1]} numbers"
            )
        for items in state.objects:
            self._check_layout(items)
        for i, items in zip(rows.tolist(), state.objects, strict=True):
            self._set_objects(i, items)
        self._note(dict(zip(rows.tolist(), state.failure, strict=True)))
        self._rows[rows] = state.rows
        self._force_range[rows, self._at.grip, 0] = -state.force_limit

    def env_model(self, env: int, model: mujoco.MjModel | None = None) -> mujoco.MjModel:
        """Environment `env`'s own model, e.g. to render it; written into `model` where given."""
        return self._batch.get_model(env, model)

    def env_data(self, env: int, data: mujoco.MjData | None = None) -> mujoco.MjData:
        """Environment `env`'s state as MjData (call mujoco.mj_forward before reading derived fields)."""
        return self._batch.get_data(env, data)

    def _ids(self, ids: Sequence[int] | np.ndarray | None) -> np.ndarray:
        if ids is None:
            return np.arange(self.num_envs)
        rows = np.atleast_1d(np.asarray(ids))
        if rows.dtype.kind not in "iu" or rows.ndim != 1 or ((rows < 0) | (rows >= self.num_envs)).any():
            raise InvalidValueError(f"ids {ids}: give whole numbers from 0 to {self.num_envs - 1}")
        return rows

    def _check_layout(self, items: tuple[ObjectSpec, ...]) -> None:
        names = tuple(o.name for o in items)
        if names != self.names:
            raise InvalidValueError(f"objects {names} in place of {self.names}: names and number must stay")
        known = {o.geometry for o in self._library}
        for item, first in zip(items, self.objects[0], strict=True):
            if item.mesh and item.geometry not in known:
                raise InvalidValueError(
                    f"mesh {item.mesh!r} of {item.name!r} is not in the library of this Mechanics"
                )
            if item.hulls != first.hulls:
                raise InvalidValueError(
                    f"object {item.name!r} has {item.hulls} convex pieces, "
                    f"before {first.hulls}: their number must stay"
                )

    def _set_objects(self, env: int, items: tuple[ObjectSpec, ...]) -> None:
        """Write environment `env`'s row of every model field that depends on the objects."""
        self.objects[env] = items
        changed = self._differences(tuple(placeless(item) for item in items))
        for name in changed.keys() - self._expanded.keys():
            self._expanded[name] = self._batch.expand(name)
        for name, rows in self._expanded.items():
            rows[env] = changed[name] if name in changed else getattr(self.model, name)[: rows.shape[1]]

    def _differences(self, key: tuple[ObjectSpec, ...]) -> dict[str, np.ndarray]:
        """Model fields in which a scene of the objects `key` differs from self.model."""
        if self._resized is not None and primitive(key):
            return self._resized.differences(key)
        if key not in self._compiled:
            model = self._build(key)
            pairs = ((name, getattr(model, name)) for name in _MODEL_ARRAYS)
            # bvh_aabb goes on with the meshes' boxes, which all environments share
            bodies = int(model.body_bvhnum.sum())
            changed = {name: a for name, a in pairs if a.tobytes() != self._base[name]}
            self._compiled.add(key, {n: a[:bodies] if n == "bvh_aabb" else a for n, a in changed.items()})
        return self._compiled[key]

    def _roll(
        self,
        opening: np.ndarray,
        force_limit: np.ndarray,
        lift_rate: np.ndarray,
        substeps: int,
        record: tuple = _RECORD,
    ) -> dict[Any, np.ndarray]:
        """MuJoCo's records of the substeps; the next call for as many writes over them."""
        if substeps < 1:
            raise InvalidValueError(f"substeps {substeps}: give at least 1")
        command = (
            self._batched("opening", opening),
            self._batched("force_limit", force_limit),
            self._batched("lift_rate", lift_rate),
        )
        if self._weaker:
            _check_ranges(command)
            widest, strongest = self.gripper.widest, self.gripper.strongest
            command = np.minimum(command[0], widest), np.minimum(command[1], strongest), command[2]
        duration = substeps * self._settings.timestep
        if not set_points(self._layout, *command, duration, self._stiffness, *self._live):
            _check_ranges(command)
        out = self._out.get((substeps, record))
        if out is None:
            # Made here, so that those who run on have their records where another one raises.
            self._out[substeps, record] = out = self._room(substeps, record)
        try:
            self._batch.rollout(substeps, record=record, out=out)
        except mujoco.batch.SimulationError as error:
            self._note_raised(error.ids)
        return out

    def _room(self, substeps: int, record: tuple) -> dict[Any, np.ndarray]:
        """For what MuJoCo records."""
        one = mujoco.MjData(self.model)
        fields = {name: getattr(one, name) for name in record}
        return {n: np.zeros((self.num_envs, substeps, *a.shape), a.dtype) for n, a in fields.items()}

    def _note_raised(self, rows: np.ndarray) -> None:
        """Rows in which MuJoCo raised keep the state that they had; the others ran."""
        self._note_broken({row: f": {self._batch.error(row)}" for row in rows.tolist()})

    def _note_warned(self) -> None:
        """Rows of which MuJoCo has warned in the last step."""
        kinds = {}
        for row, kind in np.argwhere(self._warning[:, :, 1] > self._warned).tolist():
            kinds.setdefault(row, f" warning {mujoco.mjtWarning(kind).name.removeprefix('mjWARN_')}")
        self._note_broken(kinds)

    def _note_broken(self, reasons: Mapping[int, str]) -> None:
        """The first reason stays."""
        self._note(
            {
                row: f"the simulation broke down (MuJoCo{reason}); reset this environment"
                for row, reason in reasons.items()
                if not self.failure[row]
            }
        )

    def _note(self, failures: Mapping[int, str]) -> None:
        """By row."""
        failure = list(self.failure)
        for row, reason in failures.items():
            failure[row] = reason
        self.failure, self.failed = tuple(failure), np.array([bool(reason) for reason in failure])

    def _batched(self, name: str, values: np.ndarray) -> np.ndarray:
        array = np.ascontiguousarray(values, float)
        if array.shape != (self.num_envs,):
            raise InvalidValueError(f"{name} has shape {np.shape(values)}, expected ({self.num_envs},)")
        return array


def _check_ranges(command: Sequence[np.ndarray]) -> None:
    for (name, low, high), values in zip(_RANGES, command, strict=True):
        within(name, values, low, high)


def within(name: str, values: np.ndarray, low: float, high: float) -> np.ndarray:
    """The values. Raises InvalidValueError, naming the first one that is not in low .. high (SI)."""
    wrong = ~((values >= low) & (values <= high))
    if wrong.any():
        env = int(np.argmax(wrong))
        raise InvalidValueError(
            f"{name} {values[env]} in environment {env}: give {low:g} to {high:g} (SI units)"
        )
    return values
