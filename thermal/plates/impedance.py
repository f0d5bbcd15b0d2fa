"""Surface impedances of layered bodies seen through a patch: Laplace-domain temperature per heat flux, m2 K/W.

A body is a stack of homogeneous layers of one cross-section with adiabatic sides, its far end adiabatic or held at its
first temperature. For real s > 0 the impedance of a homogeneous layer is the Laplace transform of a product of heat
kernels, sampled once in the logarithm of time where the trapezoidal rule converges exponentially; what further layers
change decays with the wave number and is added as a short series. physics: Carslaw & Jaeger, Conduction of Heat in
Solids, 2nd ed., sections 3.7 (layers), 10.3 and 14.1 (kernels).

C: patterns of a patch, S: samples, M: lateral eigenfunctions.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Literal

import numpy as np

from ..matter import Layer
from ..numerics import Sampled
from .lateral_sum import lateral_sum
from .patch import Patch
from .section import Rectangle, Section

Far = Literal["adiabatic", "isothermal"]

_LOG_STEP = 0.3  # trapezoidal rule in ln(tau): relative error exp(-pi^2 / step)
_NODES = 16  # of the rule, in whole numbers of which a section's kernel is computed
_NEGLIGIBLE_DEPTH = 20.0  # wave numbers times depth beyond which the far side is not seen, exp(-2 * 20)
_MOST_MODES = 5e3  # of a rectangle, summed one by one; more are interpolated, which is quicker then
_DECAYED = 45.0  # exponent of a kernel that is below round-off


def stack_impedance(
    layers: tuple[Layer, ...], far: Far | np.ndarray, s: np.ndarray, kappa2: np.ndarray
) -> np.ndarray:
    """Impedance (..., M) m2 K/W of one lateral eigenfunction at the near face of layers (near face first).

    s: (..., 1) 1/s, real or complex. kappa2: (M,) 1/m2. far: what is behind the last layer, an impedance (..., M) of
    its own or an end of the two kinds. Transmission-line recursion from the far end.
    """
    impedance = far if isinstance(far, np.ndarray) else None
    for layer in reversed(layers):
        k = layer.conductivity
        g = np.sqrt(s / layer.diffusivity + kappa2)
        t = _tanh(g * layer.thickness)
        if impedance is None:
            impedance = 1 / (k * g * t) if far == "adiabatic" else t / (k * g)
        else:
            impedance = (impedance + t / (k * g)) / (1 + impedance * k * g * t)
    assert impedance is not None
    return impedance


def half_space_impedance(layer: Layer, section: Section, patch: Patch, s: np.ndarray) -> Sampled:
    """Impedance of a semi-infinite rod of that cross-section and material, for real s (S,) > 0."""
    return _transform(layer, section, patch, s, None)


def layer_impedance(layer: Layer, section: Section, patch: Patch, far: Far, s: np.ndarray) -> Sampled:
    """Impedance of one layer for real s (S,) > 0. The adiabatic layer's pole at s = 0 is left out: it is the
    uniform pattern's 1/(s C), C the heat capacity per patch area, and is known exactly."""
    return _transform(layer, section, patch, s, far)


def _transform(layer: Layer, section: Section, patch: Patch, s: np.ndarray, far: Far | None) -> Sampled:
    p = s / layer.diffusivity
    widths = np.diff(patch.edges)
    first = (1e-4 * widths.min()) ** 2
    longest = _DECAYED / (p.min() + _slowest(layer.thickness, section, far))
    begin = float(np.log(first))
    tau = np.exp(np.arange(begin, np.log(longest), _LOG_STEP))
    lateral = _lateral_kernel(section, patch, begin, -len(tau) // _NODES * -_NODES)
    kernel = lateral[: len(tau)] * _depth_kernel(layer.thickness, far, tau)[:, None, None]
    if far == "adiabatic":
        uniform = patch.uniform
        kernel -= np.outer(uniform, uniform) * patch.area / (section.area * layer.thickness)
    weights = _LOG_STEP * tau * np.exp(-p[:, None] * tau)
    size = kernel.shape[1]
    flat = kernel.reshape(len(tau), -1)
    value = (weights @ flat).reshape(-1, size, size)
    slope = -((weights * tau) @ flat).reshape(-1, size, size)
    # Before the first node every cell is a half-space of its own: the rule's sum to minus infinity is a geometric one.
    value += np.eye(size) * _LOG_STEP * np.sqrt(first / np.pi) / np.expm1(_LOG_STEP / 2)
    if far == "adiabatic":
        # the pole's part of the same sum, from minus infinity to the first node, and what the rule leaves beyond the
        # last
        value -= np.outer(patch.uniform, patch.uniform) * (
            patch.area / (section.area * layer.thickness) * _LOG_STEP * first / np.expm1(_LOG_STEP)
        )
    return Sampled(value / layer.conductivity, slope / layer.conductivity / layer.diffusivity)


@lru_cache(maxsize=3)  # of up to 20 MB
def _lateral_kernel(section: Section, patch: Patch, begin: float, count: int) -> np.ndarray:
    """(count, C, C): the section's kernel at the first nodes of the rule, which materials of all kinds share. Not to be
    written to."""
    end = begin + (count - 0.5) * _LOG_STEP
    return section.kernel(patch, np.exp(np.arange(begin, end, _LOG_STEP)))


def _slowest(thickness: float, section: Section, far: Far | None) -> float:
    """Smallest squared wave number 1/m2 in the kernel that is transformed; 0 for a half-space."""
    if far is None:
        return 0.0
    if far == "isothermal":
        return (np.pi / 2 / thickness) ** 2
    return min(section.slowest, (np.pi / thickness) ** 2)


def _depth_kernel(thickness: float, far: Far | None, tau: np.ndarray) -> np.ndarray:
    """Heat kernel (J,) 1/m at the near face of [0, thickness], near face adiabatic: theta functions."""
    free = 1 / np.sqrt(np.pi * tau)
    if far is None:
        return free
    n = np.arange(1, 8)
    sign = 1.0 if far == "adiabatic" else (-1.0) ** n
    images = free * (1 + 2 * np.sum(sign * np.exp(-((n * thickness) ** 2) / tau[:, None]), axis=1))
    if far == "adiabatic":
        series = (1 + 2 * np.sum(np.exp(-((n * np.pi / thickness) ** 2) * tau[:, None]), axis=1)) / thickness
    else:
        odd = (n - 0.5) * np.pi / thickness
        series = 2 * np.sum(np.exp(-(odd**2) * tau[:, None]), axis=1) / thickness
    return np.where(tau < thickness**2 / np.pi, images, series)


def stack_profile(
    layers: tuple[Layer, ...], far: Far | np.ndarray, s: np.ndarray, kappa2: np.ndarray
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Temperatures (m2 K/W) and heat flows at the interfaces, near face first, per unit heat flux into the near face.

    Shapes as in stack_impedance; len(layers) + 1 of each. Marching in the direction of decay, it is stable at any
    depth.
    """
    flow = np.ones(np.broadcast(s, kappa2).shape, np.result_type(s, float))
    temperature = stack_impedance(layers, far, s, kappa2) * flow
    temperatures, flows = [temperature], [flow]
    for i, layer in enumerate(layers):
        k = layer.conductivity
        g = np.sqrt(s / layer.diffusivity + kappa2)
        decay = np.exp(-g * layer.thickness)
        sech = 2 * decay / (1 + decay**2)
        if i + 1 < len(layers) or isinstance(far, np.ndarray):
            beyond = stack_impedance(layers[i + 1 :], far, s, kappa2)
            flow = flow * sech / (1 + beyond * k * g * _tanh(g * layer.thickness))
            temperature = beyond * flow
        elif far == "adiabatic":
            flow, temperature = np.zeros_like(flow), temperature * sech
        else:
            flow, temperature = flow * sech, np.zeros_like(flow)
        temperatures.append(temperature)
        flows.append(flow)
    return temperatures, flows


def layered_impedance(
    layers: tuple[Layer, ...], far: Far, section: Section, patch: Patch, s: np.ndarray
) -> Sampled:
    """Impedance of a stack, near face first, for real s (S,) > 0, an adiabatic stack's pole at 0 included. A thin
    first layer takes no more memory than a thick one: what lies behind it is then interpolated between wave numbers."""
    near = layers[0]

    def correction(at: np.ndarray, kappa2: np.ndarray) -> np.ndarray:
        half_space = 1 / (near.conductivity * np.sqrt(at / near.diffusivity + kappa2))
        return stack_impedance(layers, far, at, kappa2) - half_space

    first = half_space_impedance(near, section, patch, s)
    seen = _NEGLIGIBLE_DEPTH / near.thickness
    if isinstance(section, Rectangle) and (seen / np.pi) ** 2 * section.half_x * section.half_y > _MOST_MODES:
        return first + _complex_step(lambda at: lateral_sum(section, patch, patch)(correction, at), s)
    kappa2, overlaps = section.modes(patch, seen)
    return first + _sum_modes(lambda at: correction(at, kappa2), s, overlaps, overlaps)


def transfer_impedance(
    layers: tuple[Layer, ...], section: Section, near: Patch, far: Patch, s: np.ndarray
) -> Sampled:
    """Temperature over the patterns of `far` on the far face per heat flow over those of `near`, (S, C far, C near):
    m2 K/W for flux densities, both faces otherwise adiabatic."""
    depth = sum(layer.thickness for layer in layers)
    kappa2, near_overlaps = section.modes(near, _NEGLIGIBLE_DEPTH / depth)
    _, far_overlaps = section.modes(far, _NEGLIGIBLE_DEPTH / depth)
    return _sum_modes(
        lambda at: stack_profile(layers, "adiabatic", at, kappa2)[0][-1], s, far_overlaps, near_overlaps
    )


def _tanh(x: np.ndarray) -> np.ndarray:
    """Which is 1 to round-off for most wave numbers, and slow to compute of complex numbers."""
    found = np.ones_like(x)
    small = np.real(x) < _NEGLIGIBLE_DEPTH
    found[small] = np.tanh(x[small])
    return found


def _sum_modes(
    function: Callable[[np.ndarray], np.ndarray], s: np.ndarray, left: np.ndarray, right: np.ndarray
) -> Sampled:
    """Sum over the eigenfunctions of left^T f(s, kappa) right, its slope by a complex step."""
    tiny = 1e-30
    values = function((s * (1 + 1j * tiny))[:, None])
    both = np.concatenate((np.real(values), np.imag(values) / (tiny * s[:, None])))
    symmetric = left is right
    whole = np.empty((len(both), left.shape[1], right.shape[1]))
    for i in range(left.shape[1]):
        end = i + 1 if symmetric else right.shape[1]
        whole[:, i, :end] = both @ (left[:, i, None] * right[:, :end])
        if symmetric:
            whole[:, :end, i] = whole[:, i, :end]
    return Sampled(whole[: len(s)], whole[len(s) :])


def _complex_step(function: Callable[[np.ndarray], np.ndarray], s: np.ndarray) -> Sampled:
    """A matrix function (S, C, C) at s (S,), and its slope."""
    tiny = 1e-30
    values = function(s * (1 + 1j * tiny))
    return Sampled(np.real(values), np.imag(values) / (tiny * s[:, None, None]))
