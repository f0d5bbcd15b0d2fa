"""The paper's statements on its simulated curves (section 3.2), each computed."""

from __future__ import annotations

import numpy as np

from thermograsp import thermal
from thermograsp.report.claim import Claim, graded
from thermograsp.report.paper_measures import (
    alike_until,
    at,
    end_slope,
    fall_by,
    noise,
    percent,
    relative_spread,
    sensor_effusivity,
    swap_time,
    swaps,
)
from thermograsp.report.paper_runs import MATERIALS, MODES, PaperRuns

_SWAPPED = ("plastic", "rubber")  # 3 % apart in effusivity, nearest of the ten
_SMALL = slice(0, 4)  # cotton, wood, plastic, rubber


def simulation_claims(runs: PaperRuns) -> list[Claim]:
    """Those of section 3.2."""
    return [
        alike_at_first_o(runs),
        *peaks_o(runs),
        apart_at_once_t(runs),
        peaks_t(runs),
        clearer_peaks_t(runs),
        flat_end(runs),
        peak_time(runs),
        ordered_end(runs),
        small_effusivity_o(runs),
        small_effusivity_t(runs),
    ]


def alike_at_first_o(runs: PaperRuns) -> Claim:
    smooth, until, rough = runs.smooth["O"], alike_until(runs.smooth["O"]), alike_until(runs.rough["O"])
    spread = relative_spread(smooth)
    early, late = (float(spread[int(np.argmin(np.abs(smooth.t - s)))]) for s in (0.5, 2.0))
    return Claim(
        "alike_at_first_o",
        "3.2, fig. 5a",
        "O mode: for the first 2 s the curves of all materials are too similar to be told apart.",
        f"They are alike, but for less time: the ten are {100 * early:.0f} % of their mean apart at 0.5 s, 5 % at "
        f"{until:.2f} s and {100 * late:.0f} % at 2 s (rough contact: 5 % at {rough:.2f} s). Heat then "
        f"has passed the element, of which the paper gives no properties.",
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
            f"The element's effusivity is {own:.0f} W s^0.5/(m2 K). Fall by 8 s: {percent(fall, pick(near))}: a "
            f"smaller "
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
        "T mode: the curves rise at quite different rates from the start, and after less than 2 s are easily told "
        "apart.",
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
        f"All {int(inside.sum())} of 10 do, between {times.min():.1f} and {times.max():.1f} s; by 20 s they have "
        f"fallen "
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
    slopes = {mode: end_slope(runs.smooth[mode]) for mode in MODES}
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
        f"Peak times in the order of effusivity: {', '.join(f'{x:.1f}' for x in times)} s; they fall, rise and fall "
        f"again ({turns} turns, rank correlation {rank:.2f}).",
        graded(turns > 0),
        {"peak_times_s": times.tolist(), "rank_correlation": rank, "turns": turns},
    )


def ordered_end(runs: PaperRuns) -> Claim:
    found = {mode: swaps(runs.smooth[mode].drop[:, -1]) for mode in MODES}
    gaps = {mode: runs.smooth[mode].drop[2:4, -1] for mode in MODES}
    strict, swap = not any(found.values()), swap_time(runs.smooth["T"])
    only = all(set(pairs) <= {_SWAPPED} for pairs in found.values())
    text = (
        f"At 20 s all are in order in both modes but plastic and rubber, 3 % apart in effusivity, which swap late (T "
        f"mode: "
        f"at {swap:.1f} s, in the end {gaps['T'][0]:.2f} and {gaps['T'][1]:.2f} K; O mode: {gaps['O'][0]:.2f} and "
        f"{gaps['O'][1]:.2f} K): heat has spread sideways, and conductivity counts more than effusivity."
        if only and not strict
        else f"Swapped neighbours at 20 s: {found}."
    )
    return Claim(
        "ordered_end",
        "3.2",
        "In both modes the final difference is larger the larger the effusivity.",
        text,
        graded(strict, only),
        {f"final_{mode}_K": runs.smooth[mode].drop[:, -1].tolist() for mode in MODES} | {"swap_s": swap},
    )


def small_effusivity_o(runs: PaperRuns) -> Claim:
    sweep = runs.smooth["O"]
    peaks, loss = sweep.drop[_SMALL].max(axis=1), fall_by(sweep, 8.0)
    return Claim(
        "small_effusivity_o",
        "3.2",
        "O mode: objects of small effusivity are told apart by their peaks.",
        f"Not by the heights, {peaks[0]:.2f}, {peaks[1]:.2f}, {peaks[2]:.2f} and {peaks[3]:.2f} K (cotton, wood, "
        f"plastic, "
        f"rubber), but by the fall behind them: by 8 s {percent(loss, MATERIALS[_SMALL])}; plastic and rubber are not "
        f"told "
        f"apart.",
        graded(bool(np.diff(peaks).min() > 3 * noise()), bool(loss[0] - loss[2] > 0.05)),
        {"peak_K": peaks.tolist(), "fall_by_8_s": loss[_SMALL].tolist()},
    )


def small_effusivity_t(runs: PaperRuns) -> Claim:
    t, o = (np.diff(at(runs.smooth[mode], 2.0)[_SMALL]) for mode in ("T", "O"))
    later = np.diff(at(runs.smooth["O"], 8.0)[_SMALL])
    return Claim(
        "small_effusivity_t",
        "3.2",
        "T mode: objects of small effusivity are hard to identify, for their peaks are small.",
        f"Their peaks are small but far apart: cotton, wood and plastic differ by {t[0]:.2f} and {t[1]:.2f} K at 2 s, "
        f"{t[1] / noise():.0f} times the noise and more; O mode has {o[0]:.2f} and {o[1]:.2f} K then, {later[0]:.2f} "
        f"and "
        f"{later[1]:.2f} K at 8 s. T mode is the better one for them too.",
        graded(bool(t[:2].min() < 3 * noise())),
        {"gaps_T_at_2_s_K": t.tolist(), "gaps_O_at_2_s_K": o.tolist(), "gaps_O_at_8_s_K": later.tolist()},
    )
