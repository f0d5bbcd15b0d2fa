"""One press of the sensor on an object, by any rung of the ladder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermograsp.errors import InvalidValueError, non_negative, numbers, positive

from ..contact import Pad, Surface, beside_face, pad_law
from ..matter import Material, Mode, SensorStack, Shape, Skin, Surround
from ..matter import material as named_material
from ..matter import skin as named_skin
from ..matter import surround as named_surround
from ..readout import Thermostat
from ..stack import HeatedStack, any_sensor, heated_core
from .ladder import Rung, solve_rung
from .network import LONGEST_STEP
from .problem import Conductance, PressCurves, PressProblem, checked

_MOST_SAMPLES = 10_000_000
_USUAL, _FACE = 1e4, 81e-6  # W/(m2 K), m2
_FORCE = 10.0  # N on the pad around an element


@dataclass(frozen=True, slots=True)
class Press:
    """What the sensor and the object do after a touch at t = 0.

    t: (n,) s. temperature_drop: (n,) K over the element, mean over its face. voltage: (n,) V, the Seebeck coefficient
    times the drop, before amplifier and ADC. heat_flow: (n,) W through the opening contact (T: element to object, O:
    thermostat to element). sensor_surface, object_surface: (n,) °C, means on the two sides of that contact.
    stored_heat: (n, 2) J gained by the sensor's element and by the object. rung: the model that was used, its orders
    and error bound. A quantity that the rung does not know is NaN. reading: (n,) °C of a heated sensor, as its recorder
    leaves it, whose divider's voltage is `voltage`; None of sensors that send a temperature drop.
    """

    t: np.ndarray
    temperature_drop: np.ndarray
    voltage: np.ndarray
    heat_flow: np.ndarray
    sensor_surface: np.ndarray
    object_surface: np.ndarray
    stored_heat: np.ndarray
    rung: Rung
    reading: np.ndarray | None = None


def press(
    material: str | Material,
    *,
    mode: Mode = "T",
    sensor: str | SensorStack | HeatedStack = "seed",
    skin: str | Skin | None = None,
    conductance: Conductance | None = None,
    force: Conductance | None = None,
    area: float | None = None,
    shape: Shape = "square",
    object_size: tuple[float, float, float] = (0.04, 0.04, 0.01),
    air: float = 0.0,
    sensor_temperature: float = 36.0,
    object_temperature: float = 24.0,
    seconds: float = 10.0,
    dt: float = 0.02,
    tolerance: float = 0.05,
    rung: str | Rung = "auto",
    opposite: Conductance | None = None,
    thermostat: Thermostat | None = None,
    surround: str | Material | Surround | None = None,
    surround_conductance: float | None = None,
    cache: bool = True,
) -> Press:
    """Presses the sensor on the middle of a face of an object, both uniform at first.

    material: a name of thermal.materials() or a Material. mode: "T" or "O". sensor: a preset's name, a .toml file of
    one sensor, a SensorStack or a HeatedStack. skin: over the sensor's face, a name of thermal.SKINS or a Skin, None
    for a bare face; the contact is then the skin's. conductance: W/(m2 K) of the contact, a number or a function of
    time in s (0 = apart), which counts in the middle of steps of at most 10 ms; None for 1e4, or what a heated sensor's
    contact conducts at `force`. force: N on a heated sensor, a number or a function of time in s, None for the one that
    its contact is stated at. area: m2 of the contact, at most the sensor's face, None for 81e-6 or that face where it
    is smaller. shape: "square" or "round". object_size: (width, depth, thickness) m. air: W/(m2 K) on the object's free
    faces. Temperatures in °C. seconds, dt: samples at 0, dt, 2 dt, ... up to seconds. tolerance: K of temperature drop
    from 0.05 s on, which rung="auto" (and "network") keeps. rung: a name of thermal.RUNGS, "auto", "network:ORDERS" as
    a Rung prints itself, or a Rung. opposite: conductance of a second fingertip of the same kind on the opposite face,
    None for none; the curves are the first one's. thermostat: one of finite power, at sensor_temperature at first, None
    for an ideal one. surround: what holds the element and touches the object around its face: the name of a material or
    a Material for a square pad of 20 mm, or a Surround; None for a sensor by itself. All of the pad that the object's
    face reaches then touches, as warm as the thermostat at first; heat_flow and stored_heat are those of the whole
    front and of element and pad together, the surfaces' temperatures the face's. It is in mode "T", on an ideal
    thermostat. surround_conductance: W/(m2 K) of the pad's own contact, of either fingertip while its face's conducts;
    None for that of the pad's surface, or of the skin's, under 10 N on the pad. cache: keep networks on disk.

    A heated sensor (one with a `touch` table) has been at sensor_temperature for long, in air of object_temperature,
    and its heater's law goes on from there; a controller's setpoint is that temperature. Its element in front of the
    heater is a network as other sensors' are; what is behind is uniform over the face.

    Raises UnknownNameError for names and InvalidValueError for values that make no sense, or that the rung cannot do.
    """
    named_skin(skin, mode)  # checks it
    pressed = pressed_sensor(sensor, conductance, force, skin)
    size = numbers("object_size (m)", object_size, 3)
    around, beside = named_surround(surround, mode), None
    if around is None and surround_conductance is not None:
        raise InvalidValueError(
            "surround_conductance is of the contact of a surround: give one, or leave it out"
        )
    if around is not None:
        if area is not None:
            raise InvalidValueError("with a surround all of it touches: leave area out")
        worn = named_skin(skin)
        around = around.around(_bare(pressed.stack, worn is not None))
        area = min(around.width, size[0]) * min(around.width, size[1])
        if surround_conductance is None:
            surround_conductance = _of_pad(around, worn, pressed.stack, named_material(material), size)
        beside = non_negative("surround_conductance (W/(m2 K))", surround_conductance)
    problem = PressProblem(
        stack=pressed.stack,
        material=named_material(material),
        mode=mode,
        conductance=pressed.conductance,
        area=min(_FACE, pressed.stack.face_area) if area is None else area,
        shape=shape,
        object_size=size,  # pyright: ignore[reportArgumentType]
        air=air,
        sensor_temperature=sensor_temperature,
        object_temperature=object_temperature,
        opposite=opposite,
        thermostat=thermostat,
        heated=pressed.heated,
        force=pressed.force,
        surround=around,
        beside=beside,
    )
    positive("tolerance (K)", tolerance)
    t = sample_times(seconds, dt)
    used, curves = solve_rung(str(rung), problem, t, tolerance, cache)
    return press_of(problem, t, curves, used)


def _bare(stack: SensorStack, skinned: bool) -> SensorStack:
    """The element under its skin."""
    return replace(stack, layers=stack.layers[:-1]) if skinned else stack


def _of_pad(
    around: Surround, skin: Skin | None, stack: SensorStack, body: Material, size: Sequence[float]
) -> float:
    """W/(m2 K) of the contact of what surrounds an element."""
    pad, made = Pad(width=around.width, face=stack.width), named_material(around.material)
    try:
        law = pad_law(pad, skin, made, Surface.of(body), (size[0], size[1]), (0, 1))
    except InvalidValueError as error:
        raise InvalidValueError(f"{error} (surround_conductance)") from error
    return float(beside_face(law, np.array([around.width / 2]), _FORCE, np.zeros(3), np.zeros(1)))


def sample_times(seconds: float, dt: float) -> np.ndarray:
    """0, dt, 2 dt, ... up to seconds. Raises InvalidValueError for values that make no sense."""
    positive("dt (s)", dt)
    positive("seconds", seconds)
    count = int(np.floor(seconds / dt * (1 + 1e-12))) + 1
    if count > _MOST_SAMPLES:
        raise InvalidValueError(f"{seconds:g} s at dt {dt:g} s are {count} samples: give a larger dt")
    if count < 2:
        raise InvalidValueError(
            f"{seconds:g} s at dt {dt:g} s have no sample after the touch: give a dt of {seconds:g} or less"
        )
    return np.arange(count) * dt


def press_of(problem: PressProblem, t: np.ndarray, curves: PressCurves, rung: Rung) -> Press:
    """A rung's curves with the sensor's voltage."""
    reading, voltage = None, problem.stack.seebeck * curves.temperature_drop
    if problem.heated is not None and curves.reading is not None:
        reading = curves.reading
        if len(t) > 1:
            reading = problem.heated.recorder.record_on(reading[None], float(t[1] - t[0]))[0]
        voltage = problem.heated.divider.voltage(reading)
    return Press(
        t=t,
        temperature_drop=curves.temperature_drop,
        voltage=voltage,
        heat_flow=curves.heat_flow,
        sensor_surface=curves.sensor_surface,
        object_surface=curves.object_surface,
        stored_heat=curves.stored_heat,
        rung=rung,
        reading=reading,
    )


@dataclass(frozen=True, slots=True)
class PressedSensor:
    """What a press takes of a sensor. stack: its element; heated: it, where it has a heater of its own. conductance:
    W/(m2 K) of its contact. force: N on it."""

    stack: SensorStack
    heated: HeatedStack | None
    conductance: Conductance
    force: Conductance


def pressed_sensor(
    sensor: str | SensorStack | HeatedStack,
    conductance: Conductance | None,
    force: Conductance | None,
    skin: str | Skin | None = None,
) -> PressedSensor:
    """As press takes them, None for what is left to the sensor, and for a bare face. Raises UnknownNameError and
    InvalidValueError."""
    chosen, worn = any_sensor(sensor), named_skin(skin)
    if worn is not None:
        chosen = worn.over(chosen)
    if isinstance(chosen, SensorStack):
        if force is not None:
            raise InvalidValueError(
                f"force is of heated sensors, whose contact follows it; sensor {chosen.name!r} takes a conductance"
            )
        return PressedSensor(chosen, None, _USUAL if conductance is None else conductance, np.inf)
    force = chosen.contact.force if force is None else force
    conducts = _by_force(chosen, force) if conductance is None else conductance
    return PressedSensor(heated_core(chosen, LONGEST_STEP).element, chosen, conducts, force)


def _by_force(heated: HeatedStack, force: Conductance) -> Conductance:
    """What a heated sensor's contact conducts."""

    def at(newton: float) -> float:
        return float(heated.contact.at(np.array(newton)))

    force = checked("force", force, "N")
    return (lambda time: at(force(time))) if callable(force) else at(force)
