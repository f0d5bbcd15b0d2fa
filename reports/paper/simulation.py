"""The paper's statements on its simulated curves (section 3.2), each computed."""

from __future__ import annotations

import numpy as np

from thermograsp import thermal
from thermograsp.reports.paper.claim import Finding, graded
from thermograsp.reports.paper.measures import (
    alike_until,
    at,
    end_slope,
    fall_by,
    noise,
    percent,
    relative_spread,
    rows,
    sample,
    sensor_effusivity,
    swap_time,
    swaps,
)
from thermograsp.reports.paper.runs import PaperRuns
from thermograsp.reports.paper.sweeps import MATERIALS, MODES

_SWAPPED = ("plastic", "rubber")  # 3 % apart in effusivity, nearest of the ten
_SMALL = slice(0, 4)  # cotton, wood, plastic, rubber


def alike_at_first_o(runs: PaperRuns) -> Finding:
    smooth, until, rough = runs.smooth["O"], alike_until(runs.smooth["O"]), alike_until(runs.rough["O"])
    spread = relative_spread(smooth)
    early, late = (float(spread[sample(smooth, s)]) for s in (0.5, 2.0))
    return Finding(
        f"They are alike, but for less time: the ten are {100 * early:.0f} % of their mean apart at 0.5 s, 5 % at "
        f"{until:.2f} s and {100 * late:.0f} % at 2 s (rough contact: 5 % at {rough:.2f} s). Heat then has passed "
        "the element, of which the paper gives no properties.",
        graded(until >= 2.0, until >= 0.25),
        {
            "spread_at_0.5_s": early,
            "spread_at_2_s": late,
            "alike_until_s": until,
            "alike_until_rough_s": rough,
        },
    )


def peaks_o_small(runs: PaperRuns) -> Finding:
    small, _, _, fall = _fall_by_effusivity(runs)
    return Finding(
        f"From its peak the drop falls by 8 s by: {percent(fall, small)}.",
        graded(bool((fall[small] > 0.1).all())),
        {"fall_by_8_s": fall.tolist(), "peak_K": runs.smooth["O"].drop.max(axis=1).tolist()},
    )


def peaks_o_similar(runs: PaperRuns) -> Finding:
    small, similar, _, fall = _fall_by_effusivity(runs)
    element = sensor_effusivity()
    return Finding(
        f"The element's effusivity is {element:.0f} W s^0.5/(m2 K). Fall by 8 s: {percent(fall, similar)}: a smaller "
        "peak than those of small effusivity, but a plain one.",
        graded(bool((fall[similar] < 0.1).all()), bool(fall[similar].max() < fall[small].min())),
        {"element_effusivity": element, "fall_by_8_s": fall[similar].tolist()},
    )


def peaks_o_large(runs: PaperRuns) -> Finding:
    _, _, large, fall = _fall_by_effusivity(runs)
    return Finding(
        f"Fall by 8 s: {percent(fall, large)}. Iron and aluminium have none to speak of: what falls is the flow into "
        "a plate that warms as a whole.",
        graded(bool((fall[large] < 0.01).all()), bool((fall[large] < 0.1).all())),
        {"fall_by_8_s": fall[large].tolist()},
    )


def _fall_by_effusivity(runs: PaperRuns) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Rows of the materials of smaller, about the same and larger effusivity than the element, and how much of its peak
    each curve (10,) has lost by 8 s."""
    effusivity = np.array([thermal.material(name).effusivity for name in MATERIALS])
    log_ratio, near = np.log(effusivity / sensor_effusivity()), np.log(1.5)
    small, large = np.flatnonzero(log_ratio < -near), np.flatnonzero(log_ratio > near)
    return small, np.flatnonzero(np.abs(log_ratio) <= near), large, fall_by(runs.smooth["O"], 8.0)


def apart_at_once_t(runs: PaperRuns) -> Finding:
    sweep = runs.smooth["T"]
    early = float(relative_spread(sweep)[sample(sweep, 0.2)])
    gaps = np.diff(at(sweep, 2.0))
    least = float(gaps.min())
    others = float(np.delete(gaps, MATERIALS.index("plastic")).min())
    return Finding(
        f"At 0.2 s the ten are already {early:.1f} times their mean apart. At 2 s neighbours differ by at least "
        f"{others:.2f} K, except plastic and rubber, 3 % apart in effusivity: {least:.3f} K, {least / noise():.1f} "
        "times a 16-bit converter's noise.",
        graded(early > 1 and least > 3 * noise(), early > 1),
        {"spread_at_0.2_s": early, "gaps_at_2_s_K": gaps.tolist(), "noise_K": noise()},
    )


def peaks_t(runs: PaperRuns) -> Finding:
    sweep = runs.smooth["T"]
    times = sweep.t[sweep.drop.argmax(axis=1)]
    loss = fall_by(sweep, sweep.t[-1])
    inside = (times > 0.5) & (times < 0.9 * sweep.t[-1]) & (loss > 0.001)
    return Finding(
        f"All {int(inside.sum())} of 10 do, between {times.min():.1f} and {times.max():.1f} s; by 20 s they have "
        f"fallen from it by {100 * loss.min():.1f} to {100 * loss.max():.0f} %.",
        graded(bool(inside.all())),
        {"peak_times_s": times.tolist(), "fall_by_20_s": loss.tolist()},
    )


def clearer_peaks_t(runs: PaperRuns) -> Finding:
    sweep = runs.smooth["T"]
    peaks, loss = sweep.drop.max(axis=1), fall_by(sweep, 8.0)
    rises = not swaps(peaks)
    return Finding(
        f"As heights, yes: {peaks[0]:.2f} K (cotton) to {peaks[-1]:.2f} K (aluminium), "
        f"{'in' if rises else 'not in'} the order of effusivity. As a fall after the peak, no: by 8 s "
        f"{percent(loss, rows('cotton', 'plastic', 'glass'))}, but "
        f"{percent(loss, rows('stainless_steel', 'aluminium'))}: the largest are the flattest.",
        graded(rises and bool((np.diff(loss) > 0).all()), rises),
        {"peak_K": peaks.tolist(), "fall_by_8_s": loss.tolist()},
    )


def flat_end(runs: PaperRuns) -> Finding:
    slopes = {mode: end_slope(runs.smooth[mode]) for mode in MODES}
    o, t = (100 * slopes[mode] for mode in MODES)
    return Finding(
        f"At 20 s, in the last second, the drop falls by {t[-1]:.1f} % (aluminium) to {t.max():.1f} % in T mode "
        f"and by {o[-1]:.1f} % to {o.max():.1f} % (cotton) in O mode: flat for metals, still falling for the "
        "others. A plate that loses no heat ends at the thermostat's temperature and a drop of 0, minutes later.",
        graded(max(t.max(), o.max()) < 0.5, min(t.min(), o.min()) < 0.5),
        {f"fall_in_last_second_{mode}": slopes[mode].tolist() for mode in MODES},
    )


def peak_time(runs: PaperRuns) -> Finding:
    sweep = runs.smooth["T"]
    times = sweep.t[sweep.drop.argmax(axis=1)]
    order = np.argsort(np.argsort(times))
    rank = float(np.corrcoef(np.arange(len(times)), order)[0, 1])
    turns = int(np.sum(np.diff(np.sign(np.diff(times))) != 0))
    return Finding(
        f"Peak times in the order of effusivity: {', '.join(f'{x:.1f}' for x in times)} s; they fall, rise and "
        f"fall again ({turns} turns, rank correlation {rank:.2f}).",
        graded(turns > 0),
        {"peak_times_s": times.tolist(), "rank_correlation": rank, "turns": turns},
    )


def ordered_end(runs: PaperRuns) -> Finding:
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
    return Finding(
        text,
        graded(strict, only),
        {f"final_{mode}_K": runs.smooth[mode].drop[:, -1].tolist() for mode in MODES} | {"swap_s": swap},
    )


def small_effusivity_o(runs: PaperRuns) -> Finding:
    sweep = runs.smooth["O"]
    peaks, loss = sweep.drop[_SMALL].max(axis=1), fall_by(sweep, 8.0)
    return Finding(
        f"Not by the heights, {peaks[0]:.2f}, {peaks[1]:.2f}, {peaks[2]:.2f} and {peaks[3]:.2f} K (cotton, wood, "
        f"plastic, rubber), but by the fall behind them: by 8 s {percent(loss, np.arange(4))}; plastic and "
        "rubber are not told apart.",
        graded(bool(np.diff(peaks).min() > 3 * noise()), bool(loss[0] - loss[2] > 0.05)),
        {"peak_K": peaks.tolist(), "fall_by_8_s": loss[_SMALL].tolist()},
    )


def small_effusivity_t(runs: PaperRuns) -> Finding:
    t, o = (np.diff(at(runs.smooth[mode], 2.0)[_SMALL]) for mode in ("T", "O"))
    later = np.diff(at(runs.smooth["O"], 8.0)[_SMALL])
    return Finding(
        f"Their peaks are small but far apart: cotton, wood and plastic differ by {t[0]:.2f} and {t[1]:.2f} K at 2 "
        f"s, {t[1] / noise():.0f} times the noise and more; O mode has {o[0]:.2f} and {o[1]:.2f} K then, "
        f"{later[0]:.2f} and {later[1]:.2f} K at 8 s. T mode is the better one for them too.",
        graded(bool(t[:2].min() < 3 * noise())),
        {"gaps_T_at_2_s_K": t.tolist(), "gaps_O_at_2_s_K": o.tolist(), "gaps_O_at_8_s_K": later.tolist()},
    )


FINDINGS = (
    alike_at_first_o,
    peaks_o_small,
    peaks_o_similar,
    peaks_o_large,
    apart_at_once_t,
    peaks_t,
    clearer_peaks_t,
    flat_end,
    peak_time,
    ordered_end,
    small_effusivity_o,
    small_effusivity_t,
)
"""One for each statement, named by its key."""
