"""The paper's statements on simulated and measured curves (sections 3.2, 4 and 5), each computed."""

from __future__ import annotations

import numpy as np

from thermograsp import thermal
from thermograsp.report.claim import Claim, graded
from thermograsp.report.paper_runs import MATERIALS, MODES, PaperRuns, Sweep
from thermograsp.report.paper_theory import theory_claims
from thermograsp.thermal.closed_form import equivalent_slab

_ALIKE = 0.05  # spread of the ten curves over their mean up to which they pass for alike
_SWAPPED = ("plastic", "rubber")  # 3 % apart in effusivity, nearest of the ten


def paper_claims(runs: PaperRuns) -> list[Claim]:
    """Every statement of the paper that can be computed, in its order, and the one that cannot."""
    return [
        *theory_claims(runs),
        alike_at_first_o(runs),
        *peaks_o(runs),
        apart_at_once_t(runs),
        peaks_t(runs),
        clearer_peaks_t(runs),
        flat_end(runs),
        peak_time(runs),
        ordered_end(runs),
        low_effusivity_o(runs),
        low_effusivity_t(runs),
        measured_order(runs),
        measured_early(runs),
        quicker_mode(runs),
        slower_experiment(runs),
        accordance(),
        widest_at_4_s(runs),
        tells_apart(runs),
    ]


def at(sweep: Sweep, seconds: float) -> np.ndarray:
    """Drops (10,) K at that time, which must be a sample."""
    return sweep.drop[:, int(np.argmin(np.abs(sweep.t - seconds)))]


def fall_by(sweep: Sweep, seconds: float) -> np.ndarray:
    """(10,) part of its peak that each curve has lost by that time."""
    return 1 - at(sweep, seconds) / sweep.drop.max(axis=1)


def relative_spread(sweep: Sweep) -> np.ndarray:
    """(n,) largest less smallest drop of the ten over their mean; 0 before the touch is felt."""
    mean = sweep.drop.mean(axis=0)
    return np.ptp(sweep.drop, axis=0) / np.maximum(mean, 1e-9)


def mean_difference(sweep: Sweep) -> np.ndarray:
    """(n,) K, mean over all pairs of materials."""
    pairs = np.abs(sweep.drop[:, None] - sweep.drop[None])
    count = len(MATERIALS)
    return pairs.sum(axis=(0, 1)) / (count * (count - 1))


def alike_until(sweep: Sweep) -> float:
    """s from which on the ten are apart by more than _ALIKE."""
    return float(sweep.t[np.argmax(relative_spread(sweep) > _ALIKE)])


def noise() -> float:
    """K rms a sample of a common converter on the preset's element."""
    return thermal.ADS1115.noise / thermal.sensor("seed").seebeck


def sensor_effusivity() -> float:
    """W s^0.5/(m2 K) of the element as one homogeneous layer."""
    slab = equivalent_slab(thermal.sensor("seed"))
    return float(np.sqrt(slab.conductivity * slab.heat_capacity))


def percent(values: np.ndarray, names: tuple[str, ...]) -> str:
    """Those materials' parts in %, e.g. "cotton 83 %"."""
    parts = []
    for name in names:
        value = 100 * values[MATERIALS.index(name)]
        parts.append(f"{name.replace('_', ' ')} {value:.{0 if value >= 10 else 1}f} %")
    return ", ".join(parts)


def swaps(drops: np.ndarray) -> list[tuple[str, str]]:
    """Neighbours in effusivity whose drops (10,) stand the other way round."""
    return [(MATERIALS[i], MATERIALS[i + 1]) for i in np.flatnonzero(np.diff(drops) <= 0)]


def alike_at_first_o(runs: PaperRuns) -> Claim:
    smooth, until, rough = runs.smooth["O"], alike_until(runs.smooth["O"]), alike_until(runs.rough["O"])
    spread = relative_spread(smooth)
    early, late = (float(spread[int(np.argmin(np.abs(smooth.t - s)))]) for s in (0.5, 2.0))
    return Claim(
        "alike_at_first_o",
        "3.2, fig. 5a",
        "O mode: for the first 2 s the curves of all materials are too similar to be told apart.",
        f"They are alike, but for less time: the ten are {100 * early:.0f} % of their mean apart at 0.5 s, 5 % at "
        f"{until:.2f} s and {100 * late:.0f} % at 2 s (rough contact: 5 % at {rough:.2f} s). That time is the "
        f"element's own diffusion time, and the paper does not give its properties.",
        graded(until >= 2.0, until >= 0.25),
        {
            "spread_at_0.5_s": early,
            "spread_at_2_s": late,
            "alike_until_s": until,
            "alike_until_rough_s": rough,
        },
    )


def peaks_o(runs: PaperRuns) -> list[Claim]:
    sweep, own = runs.smooth["O"], sensor_effusivity()
    fall = fall_by(sweep, 8.0)
    effusivity = np.array([thermal.material(name).effusivity for name in MATERIALS])
    below, near, above = (
        effusivity < own / 1.5,
        np.abs(np.log(effusivity / own)) <= np.log(1.5),
        effusivity > 1.5 * own,
    )
    pick = lambda mask: tuple(np.array(MATERIALS)[mask])  # noqa: E731
    where = "3.2, fig. 5a"
    return [
        Claim(
            "peaks_o_small",
            where,
            "O mode: objects of small effusivity have apparent peaks.",
            f"From its peak the drop falls by 8 s by: {percent(fall, pick(below))}.",
            graded(bool((fall[below] > 0.1).all())),
            {"fall_by_8_s": fall.tolist(), "peak_K": sweep.drop.max(axis=1).tolist()},
        ),
        Claim(
            "peaks_o_similar",
            where,
            "O mode: objects of about the sensor's effusivity have unapparent peaks.",
            f"The element's effusivity is {own:.0f} W s^0.5/(m2 K). Fall by 8 s: {percent(fall, pick(near))}: a smaller "
            f"peak than those of small effusivity, but a plain one.",
            graded(bool((fall[near] < 0.1).all()), bool(fall[near].max() < fall[below].min())),
            {"element_effusivity": own, "fall_by_8_s": fall[near].tolist()},
        ),
        Claim(
            "peaks_o_large",
            where,
            "O mode: objects of larger effusivity have no peak.",
            f"Fall by 8 s: {percent(fall, pick(above))}. Iron and aluminium have none to speak of: what falls is the "
            f"flow into a plate that warms as a whole.",
            graded(bool((fall[above] < 0.01).all()), bool((fall[above] < 0.1).all())),
            {"fall_by_8_s": fall[above].tolist()},
        ),
    ]


def apart_at_once_t(runs: PaperRuns) -> Claim:
    sweep = runs.smooth["T"]
    early = float(relative_spread(sweep)[int(np.argmin(np.abs(sweep.t - 0.2)))])
    gaps = np.diff(at(sweep, 2.0))
    least = float(gaps.min())
    others = float(np.delete(gaps, MATERIALS.index("plastic")).min())
    return Claim(
        "apart_at_once_t",
        "3.2, fig. 5b",
        "T mode: the curves rise at quite different rates from the start, and after less than 2 s are easily told apart.",
        f"At 0.2 s the ten are already {early:.1f} times their mean apart. At 2 s neighbours differ by at least "
        f"{others:.2f} K, except plastic and rubber, 3 % apart in effusivity: {least:.3f} K, {least / noise():.1f} "
        f"times a 16-bit converter's noise.",
        graded(early > 1 and least > 3 * noise(), early > 1),
        {"spread_at_0.2_s": early, "gaps_at_2_s_K": gaps.tolist(), "noise_K": noise()},
    )


def peaks_t(runs: PaperRuns) -> Claim:
    sweep = runs.smooth["T"]
    times = sweep.t[sweep.drop.argmax(axis=1)]
    loss = fall_by(sweep, sweep.t[-1])
    inside = (times > 0.5) & (times < 0.9 * sweep.t[-1]) & (loss > 0.001)
    return Claim(
        "peaks_t",
        "3.2, fig. 5b",
        "T mode: all curves have peaks.",
        f"All {int(inside.sum())} of 10 do, between {times.min():.1f} and {times.max():.1f} s; by 20 s they have fallen "
        f"from it by {100 * loss.min():.1f} to {100 * loss.max():.0f} %.",
        graded(bool(inside.all())),
        {"peak_times_s": times.tolist(), "fall_by_20_s": loss.tolist()},
    )


def clearer_peaks_t(runs: PaperRuns) -> Claim:
    sweep = runs.smooth["T"]
    peaks, loss = sweep.drop.max(axis=1), fall_by(sweep, 8.0)
    rises = not swaps(peaks)
    return Claim(
        "clearer_peaks_t",
        "3.2, 4.2",
        "T mode: peaks are more apparent the larger the effusivity, small ones unapparent.",
        f"As heights, yes: {peaks[0]:.2f} K (cotton) to {peaks[-1]:.2f} K (aluminium), {'in' if rises else 'not in'} "
        f"the order of effusivity. As a fall after the peak, no: by 8 s {percent(loss, ('cotton', 'plastic', 'glass'))}"
        f", but {percent(loss, ('stainless_steel', 'aluminium'))}: the largest are the flattest.",
        graded(rises and bool((np.diff(loss) > 0).all()), rises),
        {"peak_K": peaks.tolist(), "fall_by_8_s": loss.tolist()},
    )


def flat_end(runs: PaperRuns) -> Claim:
    slopes = {mode: _end_slope(runs.smooth[mode]) for mode in MODES}
    o, t = (100 * slopes[mode] for mode in MODES)
    return Claim(
        "flat_end",
        "3.2",
        "In the end all curves tend to a flat final difference.",
        f"At 20 s, in the last second, the drop falls by {t[-1]:.1f} % (aluminium) to {t.max():.1f} % in T mode and by "
        f"{o[-1]:.1f} % to {o.max():.1f} % (cotton) in O mode: flat for metals, still falling for the others. A plate "
        f"that loses no heat ends at the thermostat's temperature and a drop of 0, minutes later.",
        graded(max(t.max(), o.max()) < 0.5, min(t.min(), o.min()) < 0.5),
        {f"fall_in_last_second_{mode}": slopes[mode].tolist() for mode in MODES},
    )


def _end_slope(sweep: Sweep) -> np.ndarray:
    return at(sweep, sweep.t[-1] - 1) / sweep.drop[:, -1] - 1


def peak_time(runs: PaperRuns) -> Claim:
    sweep = runs.smooth["T"]
    times = sweep.t[sweep.drop.argmax(axis=1)]
    order = np.argsort(np.argsort(times))
    rank = float(np.corrcoef(np.arange(len(times)), order)[0, 1])
    turns = int(np.sum(np.diff(np.sign(np.diff(times))) != 0))
    return Claim(
        "peak_time",
        "3.2",
        "T mode: the time of the peak has no definite relation with effusivity.",
        f"Peak times in the order of effusivity: {', '.join(f'{x:.1f}' for x in times)} s; they turn {turns} times "
        f"(rank correlation {rank:.2f}).",
        graded(turns > 0),
        {"peak_times_s": times.tolist(), "rank_correlation": rank, "turns": turns},
    )


def ordered_end(runs: PaperRuns) -> Claim:
    found = {mode: swaps(runs.smooth[mode].drop[:, -1]) for mode in MODES}
    gaps = {mode: runs.smooth[mode].drop[2:4, -1] for mode in MODES}
    strict = not any(found.values())
    only = all(set(pairs) <= {_SWAPPED} for pairs in found.values())
    text = (
        f"At 20 s nine of the ten are in order in both modes; plastic and rubber swap late (from {_swap_time(runs):.1f} s on "
        f"in T mode: {gaps['T'][0]:.2f} and {gaps['T'][1]:.2f} K; O mode: {gaps['O'][0]:.2f} and {gaps['O'][1]:.2f} K): "
        f"heat has spread sideways, and conductivity counts more than effusivity."
        if only and not strict
        else f"Swapped neighbours at 20 s: {found}."
    )
    return Claim(
        "ordered_end",
        "3.2",
        "In both modes the final difference is larger the larger the effusivity.",
        text,
        graded(strict, only),
        {f"final_{mode}_K": runs.smooth[mode].drop[:, -1].tolist() for mode in MODES}
        | {"swap_s": _swap_time(runs)},
    )


def _swap_time(runs: PaperRuns) -> float:
    """s from which on plastic is above rubber in T mode; NaN if never."""
    sweep = runs.smooth["T"]
    above = sweep.drop[2] > sweep.drop[3]
    late = sweep.t > 1.0
    return float(sweep.t[late][np.argmax(above[late])]) if above[late].any() else float("nan")
