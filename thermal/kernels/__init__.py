"""Heat kernels between patches, and passive networks from them: any place, size, material and coverage, without a
search and without an eigenproblem of the body's size.

What other rooms build on:

- A contact is a rectangle on a face of the box (`Patches`) and the same rectangle on the element's face (`Rectangle`,
  m from its corner): where the object covers it.
- A contact's flow is a sum of few orthonormal patterns psi_i, the even one first, whose densities are psi_i / area:
  port i carries W, and its temperature is the mean of psi_i times the surface's. A conductance h(x) over it is the
  matrix H_ij = integral of h psi_i psi_j over it; h area I where h does not vary. `contact_patterns` tells the psi.
- Bodies are told by their impedance at the real MOMENTS between patterns, K/W, less their slowest state, and by its
  slope (`BoxSamples`). What lies between body and contact (a skin, a bond, a film) is composed there, before the
  network.
- `tip` and `box_side` are networks x' = -rates x + ports q, T = ports^T x (`ThermalNetwork`): pure functions of place,
  size, material and coverage, with at most `Resolution.rates` times the ports states and one more. A tip's network does
  not depend on what it touches, so that it may touch several objects at once. `tip_at` keeps the patterns of flow of
  one `Spot`: its errors are half as large, or less. The even pattern is the same everywhere.
- `touch_sides` makes both for one touch alone: rates and patterns are its own, so that fewer serve and errors are a
  tenth. Nothing of its fields but the elements' slowest states means anything to another touch.
- `touched_box` makes residues at fixed rates for steps that ask for no more than what is under fingertips, with places
  that were touched before; `under_tips` makes what does not depend on these.
- `glued_element` is the element of O mode: glued on the object, touched by a thermostat on its other face.
- What a pad of silicone around the element changes is another room, padded/.
- Outputs are rows on the states: a stack of other layers, read out across any of them, is another `SensorStack`.

What is left out: the film is one for all faces; patches are parallel to the faces' sides; O mode, cylinders, spheres
and meshes are still in plates/, network/ and meshes/.
"""

from .box import BoxSamples, Patches, box_kernel, box_samples
from .contact import (
    Resolution,
    Tip,
    Told,
    at_rates,
    box_side,
    compile_tip_states,
    contact_weight,
    least_weight,
    ports_told,
    residues,
    tip,
    tip_at,
    tips_at,
)
from .coverage import THIN, Footprint, Spot, contact_patterns, touch_patterns
from .element import Rectangle, element, element_samples
from .glued import GluedElement, glued_element
from .patterns import ALONG, EXPONENTS, FUNCTIONS, GRAM, JUMPS, NODES, basis_jumps, basis_shares, basis_terms
from .samples import GRASP, MOMENTS, OF_GRASP, TIMES, TO_MOMENTS, before
from .touch import Detail, states, touch_box, touch_sides
from .touched import BodyResidues, TouchedBox, UnderTips, touched_box, under_many, under_tips

__all__ = [
    "ALONG",
    "EXPONENTS",
    "FUNCTIONS",
    "GRAM",
    "GRASP",
    "JUMPS",
    "MOMENTS",
    "NODES",
    "OF_GRASP",
    "THIN",
    "TIMES",
    "TO_MOMENTS",
    "BodyResidues",
    "BoxSamples",
    "Detail",
    "Footprint",
    "GluedElement",
    "Patches",
    "Rectangle",
    "Resolution",
    "Spot",
    "Tip",
    "Told",
    "TouchedBox",
    "UnderTips",
    "at_rates",
    "basis_jumps",
    "basis_shares",
    "basis_terms",
    "before",
    "box_kernel",
    "box_samples",
    "box_side",
    "compile_tip_states",
    "contact_patterns",
    "contact_weight",
    "element",
    "element_samples",
    "glued_element",
    "least_weight",
    "ports_told",
    "residues",
    "states",
    "tip",
    "tip_at",
    "tips_at",
    "touch_box",
    "touch_patterns",
    "touch_sides",
    "touched_box",
    "under_many",
    "under_tips",
]
