"""Columns of what is noted of a fingertip on a target, sums over substeps: conductance W/K and force N on the pad, and
at the last substep that touched the pad's middle m (3) and the way it looks (3), both in the object's frame. Sums
again: the substeps that touched; how many before the last of them had not, and in how many pulses they came, of which
one that was there from the start counts half; the area m2 in contact, and it times: its length m along the second of
two axes, and along each axis the shares by which it lies aside on the sensor's face (2) and at an end of the object
(2, thermal/contact/patch_place.py). 0 stand for the whole face. Last, of a pad around the sensor that exchanges heat,
of each of its RINGS: conductance W/K, area m2 of what touches, and in how many substeps; and in how many of these a
curved object touched, narrower than what of the object is under the pad."""

from ...thermal.padded import RINGS

CONDUCTANCE, FORCE, PLACE, NORMAL = 0, 1, 2, 5
CLOSED, PAUSED, PULSES, AREA, LENGTH, ASIDE, ENDS = 8, 9, 10, 11, 12, 13, 15
BESIDE, CURVED, COLUMNS = 17, 17 + 3 * RINGS, 18 + 3 * RINGS
