"""The sensor: contact sensors of mjlab in, heat, voltages out, all on the simulation's device."""

# mjlab is installed in the environment of make test-mjlab alone, and pyright takes this folder for it
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false, reportGeneralTypeIssues=false
# pyright: reportIndexIssue=false, reportInvalidTypeForm=false, reportCallIssue=false

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import mujoco

from thermograsp.errors import (
    InvalidValueError,
    MissingDependencyError,
    celsius,
    install,
    non_negative,
    positive,
    unknown_name,
    whole_number,
)
from thermograsp.thermal import ADS1115, SIGNAL_CHAINS, Material, SignalChain
from thermograsp.thermal import material as named_material
from thermograsp.touch import TouchContacts, grasp_touch
from thermograsp.touch.scene import BodyShape, Fingertip, bodies, find, own_shapes, pads, whole_steps

from .heat import WorldsHeat

try:
    import torch
    from mjlab.sensor import ContactMatch, ContactSensor, ContactSensorCfg, Sensor, SensorCfg
except ImportError as error:
    raise MissingDependencyError(f"thermograsp.mjlab needs mjlab: {install('mjlab')}") from error

from .recording import recorded  # behind PyTorch

Worlds = torch.Tensor | slice | None


@dataclass
class ThermalTouchCfg(SensorCfg):
    """Fingertips that feel heat, in the scene of an mjlab task.

    fingertips: label -> name of a geom, site or body of the scene (`robot/left_finger`), or a Fingertip. objects:
    name of a body or geom -> a material, or several of which each world has the first until randomize_material draws
    another. dt: s between samples, whole steps of the simulation. samples: of the voltage that
    the data hold. tolerance: K of temperature drop that the heat models are made for. ambient: °C of the air and of the
    objects at first. air: W/(m2 K), of the air round the objects. chain: the electronics. compiled: whether
    torch.compile makes kernels of the heat's step, which takes a minute or more at the first step and makes the steps
    after it several times as fast.
    """

    fingertips: Mapping[str, str | Fingertip] = field(default_factory=dict)
    objects: Mapping[str, str | Material | Sequence[str | Material]] = field(default_factory=dict)
    dt: float = 0.02
    samples: int = 16
    tolerance: float = 0.05
    ambient: float = 24.0
    air: float = 5.0
    chain: SignalChain | str = ADS1115
    compiled: bool = False

    def build(self) -> ThermalTouchSensor:
        """The sensor. Raises InvalidValueError and UnknownNameError for values that cannot be."""
        return ThermalTouchSensor(self)


@dataclass(frozen=True, slots=True, eq=False)
class ThermalTouchData:
    """Tensors on the simulation's device, the same ones after every step. voltage: (worlds, fingertips, samples) V as
    the driver reports it, oldest first. temperature_drop: (worlds, fingertips) K over the sensed layer. force: (worlds,
    fingertips) N normal on the pads, and conductance: (worlds, fingertips) W/K to the object that a fingertip presses
    hardest, means over the last dt. touching: (worlds, fingertips) that object's number, -1 for none."""

    voltage: torch.Tensor
    temperature_drop: torch.Tensor
    force: torch.Tensor
    conductance: torch.Tensor
    touching: torch.Tensor


class ThermalTouchSensor(Sensor[ThermalTouchData]):
    """Made by ThermalTouchCfg.build."""

    def __init__(self, cfg: ThermalTouchCfg) -> None:
        super().__init__()
        positive("dt (s)", cfg.dt)
        positive("tolerance (K)", cfg.tolerance)
        celsius("ambient (°C)", cfg.ambient)
        non_negative("air (W/(m2 K))", cfg.air)
        whole_number("samples", cfg.samples, 1)
        if isinstance(cfg.chain, str) and cfg.chain not in SIGNAL_CHAINS:
            raise unknown_name("signal chain", cfg.chain, SIGNAL_CHAINS)
        self.cfg = cfg
        self._chain = SIGNAL_CHAINS[cfg.chain] if isinstance(cfg.chain, str) else cfg.chain
        self._materials = {name: _several(name, names) for name, names in cfg.objects.items()}
        if not self._materials:
            raise InvalidValueError(
                'objects: none given; say what may be touched, such as {"cube/cube": "wood"}'
            )
        self._sensors: list[ContactSensor] = []
        self._count = 0

    @property
    def objects(self) -> tuple[str, ...]:
        """The objects' names; `touching` counts along them."""
        return tuple(self._materials)

    def materials(self, name: str) -> tuple[Material, ...]:
        """The materials that an object may be of; a world's number counts along them. Raises UnknownNameError."""
        self._object(name)
        return self._materials[name]

    def edit_spec(self, scene_spec: mujoco.MjSpec, entities: dict[str, Any]) -> None:
        """Adds a net-force contact sensor for each fingertip on each geom of the objects; geoms without a name get one.
        Raises UnknownNameError and InvalidValueError for fingertips and objects that cannot be."""
        model = scene_spec.compile()
        shapes = self._shapes(model)
        pads(model, self.cfg.fingertips, shapes)
        bearers = [self._bearer(model, label) for label in self.cfg.fingertips]
        if len({mode for mode, _ in bearers}) > 1:
            raise InvalidValueError(
                f"fingertips: name all by geoms, or all by bodies or sites, got {bearers}"
            )
        named = {geom.id: geom for geom in scene_spec.geoms}
        for shape in shapes:
            for number in shape.geoms:
                geom = named[number]
                if not geom.name:
                    geom.name = f"{self.cfg.name}:{number}"
                wanted = ContactSensorCfg(
                    name=f"{self.cfg.name}:{geom.name}",
                    primary=ContactMatch(mode=bearers[0][0], pattern=tuple(name for _, name in bearers)),
                    secondary=ContactMatch(mode="geom", pattern=geom.name),
                    fields=("force", "pos"),
                    reduce="netforce",
                )
                sensor = wanted.build()
                sensor.edit_spec(scene_spec, entities)
                self._sensors.append(sensor)

    def initialize(self, mj_model: mujoco.MjModel, model: Any, data: Any, device: str) -> None:
        """Finds pads and objects in the compiled model and makes the state of all worlds on the device."""
        cfg = self.cfg
        self._substeps = whole_steps(cfg.dt, float(mj_model.opt.timestep))
        for sensor in self._sensors:
            sensor.initialize(mj_model, model, data, device)
        shapes = self._shapes(mj_model)
        tips = pads(mj_model, cfg.fingertips, shapes)
        shapes = own_shapes(mj_model, shapes, tips)
        worlds = data.time.shape[0]
        like = torch.zeros(worlds, device=device)
        self._fixed, ways = grasp_touch(
            mj_model,
            tips,
            shapes,
            tuple(self._materials.values()),
            dt=cfg.dt,
            substeps=self._substeps,
            tolerance=cfg.tolerance,
            ambient=cfg.ambient,
            air=cfg.air,
            chain=self._chain,
            samples=cfg.samples,
            like=like,
        )
        self._heat = WorldsHeat(
            mj_model,
            self._fixed,
            shapes,
            ways=ways,
            like=like,
            compiled=torch.compile if cfg.compiled else None,
        )
        self._run: Callable[[], None] | None = None
        self._mj_data = data
        self._material = torch.zeros((worlds, len(shapes)), dtype=torch.long, device=device)
        count, geoms = len(tips), len(self._fixed.geoms)

        def record(*shape: int) -> torch.Tensor:
            return torch.zeros((worlds, self._substeps, *shape), device=device)

        self._record = TouchContacts(
            record(count, geoms, 1, 3),
            record(count, geoms, 1, 3),
            record(count, 3),
            record(count, 3, 3),
            record(geoms, 3),
            record(geoms, 3, 3),
        )
        self._conductance = torch.zeros((worlds, count), device=device)
        read = self._heat.reading
        self._read = ThermalTouchData(
            read.voltage, read.temperature_drop, read.force, self._conductance, read.touching
        )

    def update(self, dt: float) -> None:
        """After every substep; the heat goes on once every cfg.dt."""
        super().update(dt)
        data, at, record = self._mj_data, self._count, self._record
        for g, sensor in enumerate(self._sensors):
            sensor.update(dt)
            contact = sensor.data
            record.force[:, at, :, g, 0], record.place[:, at, :, g, 0] = contact.force, contact.pos
        bodies_, geoms = self._fixed.bodies, self._fixed.geoms
        record.tip_position[:, at], record.tip_turn[:, at] = data.xpos[:, bodies_], data.xmat[:, bodies_]
        record.geom_position[:, at] = data.geom_xpos[:, geoms]
        record.geom_turn[:, at] = data.geom_xmat[:, geoms]
        self._count += 1
        if self._count == self._substeps:
            self._count = 0
            self._advance()

    def reset(self, env_ids: Worlds = None) -> None:
        """Puts those worlds' heat and electronics back to their start; their materials stay."""
        super().reset(env_ids)
        for sensor in self._sensors:
            sensor.reset(env_ids)
        worlds = slice(None) if env_ids is None else env_ids
        self._heat.reset(worlds)
        self._record.force[worlds], self._conductance[worlds] = 0.0, 0.0

    def set_material(self, name: str, numbers: torch.Tensor | int, env_ids: Worlds = None) -> None:
        """What an object is of in those worlds, by numbers of `materials`, from a fresh start. A tensor is trusted, so
        that nothing is copied to the host. Raises UnknownNameError, and InvalidValueError for an int that is none."""
        several = self.materials(name)
        if isinstance(numbers, int) and not 0 <= numbers < len(several):
            raise InvalidValueError(
                f"object {name!r} has the materials 0 to {len(several) - 1}, got {numbers}"
            )
        worlds = slice(None) if env_ids is None else env_ids
        self._material[worlds, self._object(name)] = numbers
        self.reset(env_ids)

    @property
    def material(self) -> torch.Tensor:
        """(worlds, objects) numbers of `materials`."""
        return self._material

    def _compute_data(self) -> ThermalTouchData:
        return self._read

    def _advance(self) -> None:
        """A step of the heat; on a GPU the first one is recorded, and later ones are replayed."""
        if self._run is None:
            on_gpu = self._conductance.is_cuda
            self._run = (
                recorded(self._step, (*self._heat.tensors(), self._conductance)) if on_gpu else self._step
            )
        self._run()

    def _step(self) -> None:
        heat = self._heat
        noise = torch.randn_like(self._conductance) if self._chain.noise else 0.0
        heat.advance(self._record, self._material, noise)
        most = heat.reading.touching.clamp(min=0)[..., None]
        self._conductance.copy_(heat.reading.conductance.gather(2, most)[..., 0])

    def _object(self, name: str) -> int:
        if name not in self._materials:
            raise unknown_name("object", name, self._materials)
        return self.objects.index(name)

    def _bearer(self, model: mujoco.MjModel, label: str) -> tuple[str, str]:
        """How a contact sensor names a fingertip: by its geom, or by the body that carries it."""
        fingertip = self.cfg.fingertips[label]
        name = fingertip.name if isinstance(fingertip, Fingertip) else fingertip
        kind, number = find(model, name, ("geom", "site", "body"), f"fingertip {label!r}")
        return ("geom", name) if kind == "geom" else ("body", _body_name(model, kind, number))

    def _shapes(self, model: mujoco.MjModel) -> tuple[BodyShape, ...]:
        """The objects, of their first materials; those that the MJCF itself names are left out."""
        first = {name: several[0] for name, several in self._materials.items()}
        return tuple(shape for shape in bodies(model, first, self.cfg.ambient) if shape.name in first)


def _several(name: str, names: str | Material | Sequence[str | Material]) -> tuple[Material, ...]:
    found = (names,) if isinstance(names, str | Material) else tuple(names)
    if not found:
        raise InvalidValueError(f"object {name!r}: give a material, or several, got none")
    return tuple(map(named_material, found))


def _body_name(model: mujoco.MjModel, kind: str, number: int) -> str:
    return model.body(number if kind == "body" else model.site_bodyid[number]).name
