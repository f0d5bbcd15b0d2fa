"""Contact conductance W/(m2 K) of two rough, nominally flat faces, from the pressure between them.

Solid spots and the gas around them conduct in parallel: h = h_solid + h_gas. Sources:

- plastic spots (hard pairs): h = 1.25 k (m/sigma) (P/H)^0.95. Cooper, Mikic & Yovanovich 1969, Int. J. Heat Mass
  Transfer 12:279; Yovanovich 1982, AIAA 82-0888.
- elastic spots (soft pairs): h = 1.55 k (m/sigma) (sqrt(2) P/(E' m))^0.94. Mikic 1974, ibid. 17:205.
- which of them: Mikic's (1974) plasticity index H/(E' m): plastic below 0.33, elastic above 3. In between he gives no
  law; here the two are weighted geometrically by the logarithm of the index, an interpolation.
- gas: k_g/(Y + M). Y is the distance of the mean planes, for plastic spots sigma sqrt(2) erfc^-1(2 P/H) (Cooper et
  al. 1969), for elastic ones sigma sqrt(2) erfc^-1(4 P/H_e), H_e = E' m/sqrt(2) (Mikic 1974). Yovanovich's power law
  1.53 sigma (P/H)^-0.097 (Yovanovich 1981, AIAA 81-1164) is a fit to the first within 4 % from P/H = 1e-4 to 1e-2; at
  a gripper's 1e-6 to 1e-5 it is 10 to 20 % high, so the relation itself is used.
  M = alpha beta Lambda, the temperature jump at both faces in a rarefied gas (Yovanovich 1981).

All hold for 2 <= Y/sigma <= 4.75 (Yovanovich 1982), P/H from 1e-6 to 0.023 and P/H_e to half of that. Y stays at these
ends beyond them: faces that touch without force are 4.75 sigma apart, so pressure 0 leaves the gas, the limit of small
pressures. Faces that do not touch are the caller's business: conductance 0. Radiation, some 6 W/(m2 K), is neglected.

Beyond the range, soft bodies: the spots cover P/H or P/H_e of the face, and cannot cover more than all of it. H_e is
also about the pressure at which a wavy elastic face is in full contact: pi E' D/l for waves of amplitude D and length l
(Westergaard 1939, J. Appl. Mech. 6:A49; Johnson, Contact Mechanics, section 13.2), whose mean slope is 4 D/l, so pi/4
E' m against 0.71 E' m. `joint(..., full_contact=True)` keeps the spots' conductance from there on: 1.25 k m/sigma or
1.55 k m/sigma, which is the resistance of less than one length sigma/m of bulk. A real full contact is no worse.

Faces that are not flat: if the gap between the mean planes widens by `flatness` from where they touch to the rim,
evenly over the area (a crowned face under a flat one, or a wedge), the mean of k_g/(Y + w + M) over 0 <= w <= flatness
is k_g/flatness log(1 + flatness/(Y + M)). The spots conduct nearly as before, since their conductance is nearly in
proportion to the force, wherever it is; the constriction toward where they are is left out. Bodies softer than about
pressure * width/flatness are pressed flat.

Pressures may be arrays of NumPy, PyTorch or JAX; a joint's arrays are then of the same kind.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from thermograsp.errors import InvalidValueError, finite, non_negative, positive

from ..matter import Material
from ..numerics import FARTHEST, NEAREST, Array, erfc_inverse, namespace_of

_PLASTIC_BELOW, _ELASTIC_ABOVE = 0.33, 3.0
_PLASTIC_SPOTS, _ELASTIC_SPOTS = 1.25, 1.55


@dataclass(frozen=True, slots=True)
class Surface:
    """One rough face. conductivity: W/(m K). roughness: m, rms height. slope: mean absolute asperity slope.
    youngs_modulus: Pa. poisson_ratio: 0 .. 0.5. microhardness: Pa; inf for what never yields, such as rubber.
    diffusivity: m2/s, of what is beneath, None where that is not known.

    Raises InvalidValueError for a value that no surface can have.
    """

    conductivity: float
    roughness: float
    slope: float
    youngs_modulus: float
    poisson_ratio: float = 0.3
    microhardness: float = np.inf
    diffusivity: float | None = None

    def __post_init__(self) -> None:
        for name in ("conductivity", "roughness", "slope", "youngs_modulus"):
            positive(f"surface: {name}", getattr(self, name))
        if not 0 <= finite("surface: poisson_ratio", self.poisson_ratio) <= 0.5:
            raise InvalidValueError(f"surface: poisson_ratio must be 0 .. 0.5, got {self.poisson_ratio!r}")
        if not self.microhardness > 0:
            raise InvalidValueError(f"surface: microhardness must be above 0 Pa, got {self.microhardness!r}")
        if self.diffusivity is not None:
            positive("surface: diffusivity (m2/s)", self.diffusivity)

    @classmethod
    def of(cls, material: Material) -> Surface:
        """The usual surface of a material. Its slope is typical_slope where the table has none, its Poisson ratio 0.3;
        a material without microhardness never yields. Raises InvalidValueError without roughness or Young's modulus.
        """
        if material.roughness is None or material.youngs_modulus is None:
            missing = "roughness" if material.roughness is None else "youngs_modulus"
            raise InvalidValueError(
                f"{material.name} has no {missing}, which contact conductance needs: give it, or give the conductance"
            )
        slope, ratio = material.asperity_slope, material.poisson_ratio
        return cls(
            conductivity=material.conductivity,
            roughness=material.roughness,
            slope=typical_slope(material.roughness) if slope is None else slope,
            youngs_modulus=material.youngs_modulus,
            poisson_ratio=0.3 if ratio is None else ratio,
            microhardness=np.inf if material.microhardness is None else material.microhardness,
            diffusivity=material.diffusivity,
        )


def typical_slope(roughness: float) -> float:
    """Mean absolute asperity slope of a blasted or ground face of that rms roughness (m): 0.152 (sigma/um)^0.4.

    Tanner & Fahoum 1976, Wear 36:299. The scatter of measured slopes is a factor of two.
    """
    return 0.152 * (roughness * 1e6) ** 0.4


# Conductivity as in the seed's element; modulus, Poisson ratio and hardness of 99.5 % alumina from CoorsTek's table of
# properties (AD-995); 0.4 um is an estimate for a lapped substrate (as fired 0.6 to 1 um, polished below 0.1 um).
LAPPED_ALUMINA = Surface(
    conductivity=25.0,
    roughness=0.4e-6,
    slope=typical_slope(0.4e-6),
    youngs_modulus=372e9,
    poisson_ratio=0.22,
    microhardness=14.1e9,
)
"""The fingertip's face."""

# Nickel-plated copper, lapped: Incropera & DeWitt, table A.1; roughness and hardness are estimates.
THERMOSTAT_FACE = Surface(
    conductivity=400.0,
    roughness=0.4e-6,
    slope=0.1,
    youngs_modulus=120e9,
    poisson_ratio=0.34,
    microhardness=1.3e9,
)
"""What touches the glued-on element in O mode."""


@dataclass(frozen=True, slots=True)
class Gas:
    """Gas in the gap. conductivity: W/(m K). mean_free_path: m. heat_ratio: c_p/c_v. prandtl: -.
    accommodation: thermal accommodation coefficient of both faces, in (0, 1]."""

    conductivity: float
    mean_free_path: float
    heat_ratio: float
    prandtl: float
    accommodation: float

    @property
    def jump(self) -> float:
        """M in m: alpha beta Lambda, alpha = 2 (2 - a)/a, beta = 2 gamma/(Pr (gamma + 1)) (Yovanovich 1981)."""
        alpha = 2 * (2 - self.accommodation) / self.accommodation
        beta = 2 * self.heat_ratio / (self.prandtl * (self.heat_ratio + 1))
        return alpha * beta * self.mean_free_path


AIR = Gas(conductivity=0.0263, mean_free_path=67.0e-9, heat_ratio=1.4, prandtl=0.707, accommodation=0.83)
"""300 K and 101 kPa. Conductivity and Prandtl number: Incropera & DeWitt, table A.4. Mean free path from its viscosity,
mu/p sqrt(pi R T/2). Accommodation: correlation of Song & Yovanovich 1987 (ASME HTD 69:107) for air on alumina."""


@dataclass(frozen=True, slots=True)
class Joint:
    """What the conductance of a pair of faces depends on besides pressure; scalars, or arrays with an entry a row.

    conductivity: W/(m K), harmonic mean. roughness: m, and slope: -, combined. hardness: Pa, the softer face's
    microhardness. elastic_hardness: Pa, E' m/sqrt(2). elastic_share: 0 plastic .. 1 elastic.
    gas_conductivity: W/(m K), 0 in vacuum. jump: m, the gas parameter M. solid_most: W/(m2 K), what the spots conduct
    at most, inf where the law goes on. flatness: m, by which the gap widens from where the faces touch to its widest.
    """

    conductivity: float | Array
    roughness: float | Array
    slope: float | Array
    hardness: float | Array
    elastic_hardness: float | Array
    elastic_share: float | Array
    gas_conductivity: float | Array
    jump: float | Array
    solid_most: float | Array = np.inf
    flatness: float | Array = 0.0


def joint(
    first: Surface,
    second: Surface,
    gas: Gas | None = AIR,
    *,
    full_contact: bool = False,
    flatness: float = 0.0,
) -> Joint:
    """The pair's joint; order does not matter. gas: None for vacuum. full_contact: whether the spots conduct no more
    than where they cover the whole face; False continues the law of spots, as it was fitted to little of it.
    flatness: m, by which the gap between the faces widens from where they touch to the rim; 0 for flat ones.

    Raises InvalidValueError for a flatness below 0."""
    slope = float(np.hypot(first.slope, second.slope))
    compliance = sum((1 - face.poisson_ratio**2) / face.youngs_modulus for face in (first, second))
    hardness = min(first.microhardness, second.microhardness)
    share = _elastic_share(hardness * compliance / slope)
    conductivity = 2 * first.conductivity * second.conductivity / (first.conductivity + second.conductivity)
    roughness = float(np.hypot(first.roughness, second.roughness))
    covered = conductivity * slope / roughness * _PLASTIC_SPOTS ** (1 - share) * _ELASTIC_SPOTS**share
    return Joint(
        conductivity=conductivity,
        roughness=roughness,
        slope=slope,
        hardness=hardness,
        elastic_hardness=slope / compliance / math.sqrt(2),
        elastic_share=share,
        gas_conductivity=gas.conductivity if gas else 0.0,
        jump=gas.jump if gas else 0.0,
        solid_most=covered if full_contact else np.inf,
        flatness=non_negative("flatness (m)", flatness),
    )


def _elastic_share(plasticity_index: float) -> float:
    position = np.log(plasticity_index / _PLASTIC_BELOW) / np.log(_ELASTIC_ABOVE / _PLASTIC_BELOW)
    return float(np.clip(position, 0.0, 1.0))


def stack_joints(joints: Sequence[Joint]) -> Joint:
    """One Joint of arrays (B,) for a batch of pairs."""
    names = [field.name for field in fields(Joint)]
    return Joint(**{name: np.array([getattr(one, name) for one in joints], dtype=float) for name in names})


def contact_conductance(joint: Joint, pressure: Array | float) -> Array:
    """Solid and gas together, W/(m2 K), elementwise. pressure: Pa, >= 0, any shape that fits the joint's.

    Raises InvalidValueError for a NumPy pressure that is negative or not finite. Tensors are not looked into, so that
    the function can be traced: negative ones give NaN.
    """
    return solid_conductance(joint, pressure) + gas_conductance(joint, pressure)


def solid_conductance(joint: Joint, pressure: Array | float) -> Array:
    """That of the touching spots, W/(m2 K), elementwise; 0 at pressure 0."""
    pressed = _pressure(pressure)
    plastic = _PLASTIC_SPOTS * (pressed / joint.hardness) ** 0.95
    elastic = _ELASTIC_SPOTS * (pressed / joint.elastic_hardness) ** 0.94
    shape = plastic ** (1 - joint.elastic_share) * elastic**joint.elastic_share
    return (joint.conductivity * joint.slope / joint.roughness * shape).clip(None, joint.solid_most)


def gas_conductance(joint: Joint, pressure: Array | float) -> Array:
    """That of the gas between the spots, W/(m2 K), elementwise."""
    pressed = _pressure(pressure)
    plastic = erfc_inverse((2 * pressed / joint.hardness).clip(FARTHEST, NEAREST))
    elastic = erfc_inverse((4 * pressed / joint.elastic_hardness).clip(FARTHEST, NEAREST))
    separation = math.sqrt(2) * (plastic * (1 - joint.elastic_share) + elastic * joint.elastic_share)
    gap = joint.roughness * separation + joint.jump
    widens = joint.flatness / gap
    xp = namespace_of(gap)
    mean = xp.where(widens > 0, xp.log1p(widens) / xp.where(widens > 0, widens, 1 + widens), 1 + widens)
    return joint.gas_conductivity / gap * mean


def covered_share(joint: Joint, pressure: Array | float) -> Array:
    """Share of the face that spots cover by their laws, elementwise: P/H, P/H_e or between them as the conductance is.
    The laws hold up to 0.023 where spots are plastic, 0.011 where they are elastic; above 1 there are no spots."""
    pressed = _pressure(pressure)
    plastic, elastic = pressed / joint.hardness, pressed / joint.elastic_hardness
    return plastic ** (1 - joint.elastic_share) * elastic**joint.elastic_share


def _pressure(pressure: Array | float) -> Array:
    if namespace_of(pressure) is not np:
        return pressure
    # Contiguous: NumPy may take another loop, of other rounding, for strided rows.
    pressure = np.ascontiguousarray(pressure, dtype=float).reshape(np.shape(pressure))
    if not (np.isfinite(pressure) & (pressure >= 0)).all():
        raise InvalidValueError(
            f"pressure must be finite and >= 0 Pa, got {pressure.min():g} to {pressure.max():g}"
        )
    return pressure
