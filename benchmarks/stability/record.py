"""What `thermograsp bench stability` saves."""

from __future__ import annotations

from thermograsp.bench.kinds import Progress, Record
from thermograsp.bench.stability.measure import NAMES, STEPS, TOLERANCE, atlas
from thermograsp.thermal import material

_MATERIALS = ("wood", "glass", "stainless_steel", "aluminium")
_STEP, _CELL, _CONDUCTANCES = 0.02, 1e-4, (1e3, 1e4, 1e5)  # s, m, W/(m2 K)


def measured(quick: bool, seed: int, progress: Progress) -> Record:
    """Every scheme's map."""
    pixels, steps = (20, 200) if quick else (64, STEPS)
    with progress(10) as advance:
        maps = atlas(pixels, steps, seed, lambda doing: advance(doing, 1))
    return {
        "steps": steps,
        "tolerance": TOLERANCE,
        "kinds": NAMES,
        "presses": {name: _press(name) for name in _MATERIALS},
        "maps": [
            {
                "scheme": each.key,
                "title": each.title,
                "note": each.note,
                "axes": each.axes,
                "x": each.x,
                "y": each.y,
                "kind": each.kinds,
                "shares": {name: each.share(kind) for kind, name in enumerate(NAMES)},
                "outside": each.outside.max(),
                "heat_from_nowhere": each.heat.max(),
                "limits": [
                    {"name": line.name, "x": line.x, "y": line.y, "label": line.label} for line in each.lines
                ],
            }
            for each in maps
        ],
    }


def _press(name: str) -> Record:
    """Where a press computed on cells of 0.1 mm in steps of 20 ms lies, at three conductances."""
    chosen = material(name)
    return {
        "fourier": chosen.diffusivity * _STEP / _CELL**2,
        "stiffness": [h * _CELL / chosen.conductivity for h in _CONDUCTANCES],
    }
