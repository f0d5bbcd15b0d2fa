"""The paper's statements on its experiment and its conclusions (sections 3.2 end, 4 and 5), each computed."""

from __future__ import annotations

import numpy as np

from thermograsp.report.claim import Claim, graded
from thermograsp.report.paper_measures import (
    alike_until,
    at,
    fall_by,
    mean_difference,
    noise,
    percent,
    rise_time,
    swaps,
)
from thermograsp.report.paper_runs import MATERIALS, MODES, PRESSURE, ROUGHNESS, PaperRuns

_SAME_PEAK = 0.25  # s, within which the top of a curve as flat as cotton's in T mode cannot be placed


def experiment_claims(runs: PaperRuns) -> list[Claim]:
    """Those of sections 4 and 5."""
    return [
        measured_order(runs),
        measured_o(runs),
        measured_t(runs),
        slower_experiment(runs),
        later_end(runs),
        quicker_mode(runs),
        accordance(),
        widest_at_4_s(runs),
        tells_apart(runs),
    ]


def measured_order(runs: PaperRuns) -> Claim:
    found = {mode: swaps(runs.rough[mode].drop[:, -1]) for mode in MODES}
    named = {mode: ", ".join(f"{a}/{b}" for a, b in pairs) or "none" for mode, pairs in found.items()}
    return Claim(
        "measured_order",
        "4.2, fig. 6",
        "Measured in both modes, the final difference is larger the larger the effusivity.",
        f"With rough contacts ({ROUGHNESS * 1e6:g} um rms, {PRESSURE / 1e3:g} kPa) neighbours swapped at 20 s: T mode "
        f"{named['T']}, O mode {named['O']}. All others are in order.",
        graded(not any(found.values()), all(len(pairs) <= 1 for pairs in found.values())),
        {f"final_{mode}_K": runs.rough[mode].drop[:, -1].tolist() for mode in MODES},
    )


def measured_o(runs: PaperRuns) -> Claim:
    sweep = runs.rough["O"]
    fall, until = fall_by(sweep, 8.0), alike_until(sweep)
    seen = ("cotton", "rubber", "glass", "marble", "stainless_steel", "aluminium")
    falling = bool((np.diff(fall[:7]) < 0).all()) and bool(fall[7:].max() < 0.01)
    return Claim(
        "measured_o",
        "4.2, fig. 6",
        "Measured in O mode, the curves are alike for a short time; objects of small effusivity have apparent peaks, "
        "those of large effusivity unobvious ones or none.",
        f"With rough contact they are within 5 % of each other up to {until:.2f} s. Fall from the peak by 8 s: "
        f"{percent(fall, seen)}.",
        graded(falling and until > 0.25),
        {"alike_until_s": until, "fall_by_8_s": fall.tolist()},
    )


def measured_t(runs: PaperRuns) -> Claim:
    sweep = runs.rough["T"]
    gaps = np.diff(at(sweep, 2.0))
    return Claim(
        "measured_t",
        "4.2, fig. 6",
        "Measured in T mode, the curves of all objects are apparently different, so they are identified easily and "
        "fast.",
        f"With rough contacts neighbours differ at 2 s by {gaps.min():.2f} to {gaps.max():.2f} K, "
        f"{gaps.min() / noise():.0f} "
        f"times a 16-bit converter's noise or more (each material has a contact of its own).",
        graded(bool(gaps.min() > 3 * noise())),
        {"gaps_at_2_s_K": gaps.tolist()},
    )


def slower_experiment(runs: PaperRuns) -> Claim:
    smooth, rough = ({mode: rise_time(which[mode]) for mode in MODES} for which in (runs.smooth, runs.rough))
    slower = bool((rough["O"] > 1.1 * smooth["O"]).all() and (rough["T"][1:] > smooth["T"][1:]).all())
    return Claim(
        "slower_experiment",
        "4.2",
        "The experiment changes more slowly than the simulation, possibly for the thermal resistance of the air gap "
        "that "
        "rough faces leave.",
        f"The gap alone does it. Time to 90 % of the peak, smooth and rough: T mode glass {smooth['T'][4]:.2f} and "
        f"{rough['T'][4]:.2f} s, aluminium {smooth['T'][-1]:.2f} and {rough['T'][-1]:.2f} s, O mode aluminium "
        f"{smooth['O'][-1]:.2f} and {rough['O'][-1]:.2f} s; only cotton in T mode, {smooth['T'][0]:.2f} and "
        f"{rough['T'][0]:.2f} s, is so slow itself that its contact hardly counts.",
        graded(slower),
        {
            f"rise_{kind}_{mode}_s": times[mode].tolist()
            for kind, times in (("smooth", smooth), ("rough", rough))
            for mode in MODES
        },
    )


def later_end(runs: PaperRuns) -> Claim:
    smooth, rough = (
        {mode: which[mode].t[which[mode].drop.argmax(axis=1)] for mode in MODES}
        for which in (runs.smooth, runs.rough)
    )
    later = all((rough[mode] >= smooth[mode] - _SAME_PEAK).all() for mode in MODES)
    return Claim(
        "later_end",
        "4.2",
        "The experiment needs longer to tend to its final difference.",
        f"Peaks come later with rough contact, smooth and rough: T mode glass {smooth['T'][4]:.1f} and "
        f"{rough['T'][4]:.1f} s, aluminium {smooth['T'][-1]:.1f} and {rough['T'][-1]:.1f} s; O mode glass "
        f"{smooth['O'][4]:.1f} and {rough['O'][4]:.1f} s, aluminium {smooth['O'][-1]:.1f} and {rough['O'][-1]:.1f} s. "
        f"Only cotton's in T mode stays, at {smooth['T'][0]:.1f} and {rough['T'][0]:.1f} s.",
        graded(later),
        {
            f"peak_{kind}_{mode}_s": times[mode].tolist()
            for kind, times in (("smooth", smooth), ("rough", rough))
            for mode in MODES
        },
    )


def quicker_mode(runs: PaperRuns) -> Claim:
    moments = (0.5, 1.0, 2.0)
    pairs = {mode: mean_difference(runs.smooth[mode]) for mode in MODES}
    t = runs.smooth["T"].t
    early = {mode: [float(pairs[mode][int(np.argmin(np.abs(t - s)))]) for s in moments] for mode in MODES}
    level = early["T"][0]
    reached = float(t[np.argmax(pairs["O"] >= level)])
    return Claim(
        "quicker_mode",
        "3.2, 4.2",
        "T mode suits identification better: it tells materials apart sooner than O mode.",
        f"Mean difference of a pair at 0.5, 1 and 2 s: T mode {early['T'][0]:.2f}, {early['T'][1]:.2f} and "
        f"{early['T'][2]:.2f} K, O mode {early['O'][0]:.2f}, {early['O'][1]:.2f} and {early['O'][2]:.2f} K. What T "
        f"mode has "
        f"after 0.5 s O mode has after {reached:.1f} s.",
        graded(all(a > b for a, b in zip(early["T"], early["O"], strict=True))),
        {"pair_T_K": early["T"], "pair_O_K": early["O"], "o_mode_catches_up_s": reached},
    )


def accordance() -> Claim:
    return Claim(
        "accordance",
        "5",
        "Simulation and experiment agree well.",
        "Cannot be computed: the measured curves are published as a picture without numbers.",
        "open",
    )


def widest_at_4_s(runs: PaperRuns) -> Claim:
    spread = {mode: np.ptp(runs.smooth[mode].drop, axis=0) for mode in MODES}
    t = runs.smooth["T"].t
    at_4 = int(np.argmin(np.abs(t - 4.0)))
    share = {mode: float(spread[mode][at_4] / spread[mode].max()) for mode in MODES}
    widest = {mode: float(t[spread[mode].argmax()]) for mode in MODES}
    near = t[spread["T"] >= 0.99 * spread["T"].max()]
    return Claim(
        "widest_at_4_s",
        "5",
        "With good contact the curves separate early, and materials differ most at about 4 s.",
        f"T mode: cotton and aluminium are farthest apart at {widest['T']:.1f} s, {spread['T'].max():.2f} K, and stay "
        f"within "
        f"1 % of that from {near[0]:.1f} to {near[-1]:.1f} s, at 4 s {spread['T'][at_4]:.2f} K: a plateau rather than "
        f"a "
        f"maximum. O mode: {spread['O'][at_4]:.1f} K at 4 s, but they go on parting, to {spread['O'].max():.1f} K at "
        f"{widest['O']:.0f} s.",
        graded(min(share.values()) > 0.99, share["T"] > 0.99),
        {f"widest_{m}_s": widest[m] for m in MODES} | {f"share_at_4_s_{m}": share[m] for m in MODES},
    )


def tells_apart(runs: PaperRuns) -> Claim:
    drops = at(runs.smooth["T"], 4.0)
    gaps = np.diff(np.sort(drops))
    apart = int(np.sum(gaps > 3 * noise()))
    least = int(gaps.argmin())
    order = np.argsort(drops)
    pair = " and ".join(MATERIALS[order[least + k]] for k in (0, 1))
    return Claim(
        "tells_apart",
        "5",
        "The sensor can tell objects of different thermal properties apart.",
        f"At 4 s in T mode {apart} of 9 neighbouring pairs differ by more than three times a converter's noise in a "
        f"single "
        f"sample, the next but least by {np.sort(gaps)[1]:.2f} K; {pair} differ by {gaps.min():.3f} K and are not.",
        graded(apart == 9, apart >= 8),
        {"gaps_at_4_s_K": gaps.tolist(), "pairs_apart": float(apart)},
    )
