"""What contacts that come and go within a sample resist beyond their mean conductance.

Heat passes such a contact in pulses. Each warms the faces beyond what the mean flow would, which costs the mean flow a
resistance. Of pulses of an even flow that last a share d of each period P, between bodies of effusivities e and e', it
is

    (1/e + 1/e') sqrt(P/pi) f(d) / A,   f(d) = sum over n = 1, 2, .. of (sin(pi n d)/(pi n d))^2 / sqrt(n)

under a contact of area A: the power that the flow's Fourier series loses in the impedances 1/(e sqrt(i w)) of two
half-spaces, over the square of the mean. With s^2 = d (1 - d), d^2 f(d) is within 1 % of s^3 (4/3 - 1.29 s + 0.83 s^2),
whose first term is that of short pulses (Carslaw and Jaeger 1959, 2.9).
"""

from __future__ import annotations

from thermograsp.compiled import njit

from ....thermal.numerics import Array, namespace_of


def ripple(share, pulses):
    """f(d) of a contact that is closed for a share 0 < d < 1 of a sample, over the root of how many pulses that is."""
    spread = share * (1.0 - share)
    root = spread**0.5
    return root * spread * (4.0 / 3.0 - 1.29 * root + 0.83 * spread) / (share * share * pulses**0.5)


compiled_ripple = njit(cache=True, error_model="numpy", inline="always")(ripple)


def array_ripple(share: Array, pulses: Array) -> Array:
    """ripple of a share 0 <= d <= 1, 0 where the contact neither comes nor goes. pulses: half of how often it
    has come and gone within the sample."""
    xp = namespace_of(share)
    changes = (share > 0) & (share < 1)
    safe = xp.where(changes, share, 0.5 + 0.0 * share)
    return xp.where(changes, ripple(safe, pulses.clip(1.0, None)), 0.0 * share)
