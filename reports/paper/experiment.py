"""The paper's statements on its experiment and its conclusions (sections 3.2 end, 4 and 5), each computed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermograsp.reports.paper.claim import Finding, graded
from thermograsp.reports.paper.measures import (
    alike_until,
    at,
    fall_by,
    mean_difference,
    noise,
    percent,
    rise_time,
    rows,
    sample,
    swaps,
)
from thermograsp.reports.paper.runs import PaperRuns
from thermograsp.reports.paper.sweeps import (
    MATERIALS,
    MODES,
    PRESSURE,
    ROUGHNESS,
)

_SAME_PEAK = 0.25  # s, within which the top of a curve as flat as cotton's in T mode cannot be placed


def measured_order(runs: PaperRuns) -> Finding:
    found = {mode: swaps(runs.rough[mode].drop[:, -1]) for mode in MODES}
    named = {mode: ", ".join(f"{a}/{b}" for a, b in pairs) or "none" for mode, pairs in found.items()}
    return Finding(
        f"With rough contacts ({ROUGHNESS * 1e6:g} um rms, {PRESSURE / 1e3:g} kPa) neighbours swapped at 20 s: T "
        f"mode {named['T']}, O mode {named['O']}. All others are in order.",
        graded(not any(found.values()), all(len(pairs) <= 1 for pairs in found.values())),
        {f"final_{mode}_K": runs.rough[mode].drop[:, -1].tolist() for mode in MODES},
    )


def measured_o(runs: PaperRuns) -> Finding:
    sweep = runs.rough["O"]
    fall, until = fall_by(sweep, 8.0), alike_until(sweep)
    seen = rows("cotton", "rubber", "glass", "marble", "stainless_steel", "aluminium")
    falling = bool((np.diff(fall[:7]) < 0).all()) and bool(fall[7:].max() < 0.01)
    return Finding(
        f"With rough contact they are within 5 % of each other up to {until:.2f} s. Fall from the peak by 8 s: "
        f"{percent(fall, seen)}.",
        graded(falling and until > 0.25),
        {"alike_until_s": until, "fall_by_8_s": fall.tolist()},
    )


def measured_t(runs: PaperRuns) -> Finding:
    sweep = runs.rough["T"]
    gaps = np.diff(at(sweep, 2.0))
    return Finding(
        f"With rough contacts neighbours differ at 2 s by {gaps.min():.2f} to {gaps.max():.2f} K, "
        f"{gaps.min() / noise():.0f} times a 16-bit converter's noise or more (each material has a contact of its "
        "own).",
        graded(bool(gaps.min() > 3 * noise())),
        {"gaps_at_2_s_K": gaps.tolist()},
    )


def slower_experiment(runs: PaperRuns) -> Finding:
    smooth, rough = ({mode: rise_time(which[mode]) for mode in MODES} for which in (runs.smooth, runs.rough))
    slower = bool((rough["O"] > 1.1 * smooth["O"]).all() and (rough["T"][1:] > smooth["T"][1:]).all())
    return Finding(
        f"The gap alone does it. Time to 90 % of the peak, smooth and rough: T mode glass {smooth['T'][4]:.2f} and "
        f"{rough['T'][4]:.2f} s, aluminium {smooth['T'][-1]:.2f} and {rough['T'][-1]:.2f} s, O mode aluminium "
        f"{smooth['O'][-1]:.2f} and {rough['O'][-1]:.2f} s; only cotton in T mode, {smooth['T'][0]:.2f} and "
        f"{rough['T'][0]:.2f} s, is so slow itself that its contact hardly counts.",
        graded(slower),
        _by_contact("rise", smooth, rough),
    )


def later_end(runs: PaperRuns) -> Finding:
    smooth, rough = (
        {mode: which[mode].t[which[mode].drop.argmax(axis=1)] for mode in MODES}
        for which in (runs.smooth, runs.rough)
    )
    later = all((rough[mode] >= smooth[mode] - _SAME_PEAK).all() for mode in MODES)
    return Finding(
        f"Peaks come later with rough contact, smooth and rough: T mode glass {smooth['T'][4]:.1f} and "
        f"{rough['T'][4]:.1f} s, aluminium {smooth['T'][-1]:.1f} and {rough['T'][-1]:.1f} s; O mode glass "
        f"{smooth['O'][4]:.1f} and {rough['O'][4]:.1f} s, aluminium {smooth['O'][-1]:.1f} and {rough['O'][-1]:.1f} "
        f"s. Only cotton's in T mode stays, at {smooth['T'][0]:.1f} and {rough['T'][0]:.1f} s.",
        graded(later),
        _by_contact("peak", smooth, rough),
    )


def _by_contact(
    what: str, smooth: Mapping[str, np.ndarray], rough: Mapping[str, np.ndarray]
) -> dict[str, list[float]]:
    """Times s of the materials by name, of both contacts and modes."""
    return {
        f"{what}_{kind}_{mode}_s": times[mode].tolist()
        for kind, times in (("smooth", smooth), ("rough", rough))
        for mode in MODES
    }


def quicker_mode(runs: PaperRuns) -> Finding:
    moments = (0.5, 1.0, 2.0)
    pairs = {mode: mean_difference(runs.smooth[mode]) for mode in MODES}
    t = runs.smooth["T"].t
    early = {mode: [float(pairs[mode][sample(runs.smooth[mode], s)]) for s in moments] for mode in MODES}
    level = early["T"][0]
    reached = float(t[np.argmax(pairs["O"] >= level)])
    return Finding(
        f"Mean difference of a pair at 0.5, 1 and 2 s: T mode {early['T'][0]:.2f}, {early['T'][1]:.2f} and "
        f"{early['T'][2]:.2f} K, O mode {early['O'][0]:.2f}, {early['O'][1]:.2f} and {early['O'][2]:.2f} K. What T "
        f"mode has after 0.5 s O mode has after {reached:.1f} s.",
        graded(all(a > b for a, b in zip(early["T"], early["O"], strict=True))),
        {"pair_T_K": early["T"], "pair_O_K": early["O"], "o_mode_catches_up_s": reached},
    )


def accordance(_: PaperRuns) -> Finding:
    return Finding(
        "Cannot be computed: the measured curves are published as a picture without numbers.",
        "open",
    )


def widest_at_4_s(runs: PaperRuns) -> Finding:
    spread = {mode: np.ptp(runs.smooth[mode].drop, axis=0) for mode in MODES}
    t = runs.smooth["T"].t
    at_4 = sample(runs.smooth["T"], 4.0)
    share = {mode: float(spread[mode][at_4] / spread[mode].max()) for mode in MODES}
    widest = {mode: float(t[spread[mode].argmax()]) for mode in MODES}
    near = t[spread["T"] >= 0.99 * spread["T"].max()]
    return Finding(
        f"T mode: cotton and aluminium are farthest apart at {widest['T']:.1f} s, {spread['T'].max():.2f} K, and "
        f"stay within 1 % of that from {near[0]:.1f} to {near[-1]:.1f} s, at 4 s {spread['T'][at_4]:.2f} K: a "
        f"plateau rather than a maximum. O mode: {spread['O'][at_4]:.1f} K at 4 s, but they go on parting, to "
        f"{spread['O'].max():.1f} K at {widest['O']:.0f} s.",
        graded(min(share.values()) > 0.99, share["T"] > 0.99),
        {f"widest_{m}_s": widest[m] for m in MODES} | {f"share_at_4_s_{m}": share[m] for m in MODES},
    )


def tells_apart(runs: PaperRuns) -> Finding:
    drops = at(runs.smooth["T"], 4.0)
    gaps = np.diff(np.sort(drops))
    distinct = int(np.sum(gaps > 3 * noise()))
    least = int(gaps.argmin())
    order = np.argsort(drops)
    pair = " and ".join(MATERIALS[order[least + k]] for k in (0, 1))
    return Finding(
        f"At 4 s in T mode {distinct} of 9 neighbouring pairs differ by more than three times a converter's noise in "
        f"a single sample, the next but least by {np.sort(gaps)[1]:.2f} K; {pair} differ by {gaps.min():.3f} K and "
        "are not.",
        graded(distinct == 9, distinct >= 8),
        {"gaps_at_4_s_K": gaps.tolist(), "pairs_apart": float(distinct)},
    )


ON_RIGS = (measured_order, measured_o, measured_t, slower_experiment, later_end)
"""Those that rough contacts decide, so that what is not known of the experiment may decide them."""

FINDINGS = (
    measured_order,
    measured_o,
    measured_t,
    slower_experiment,
    later_end,
    quicker_mode,
    accordance,
    widest_at_4_s,
    tells_apart,
)
"""One for each statement, named by its key."""
