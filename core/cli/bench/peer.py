"""`thermograsp bench peer`: a peer's published contact temperatures beside ours and the exact ones."""

from __future__ import annotations

from thermograsp.bench import Record
from thermograsp.cli.shared import Output

_TITLES = {
    "thermograsp, 1-D": "column",
    "thermograsp, 40 x 40 x 10 mm plate": "slab",
    "the same, 1e4 W/(m2 K)": "soft",
    "peer, quoted": "peer",
}


def report(record: Record, output: Output) -> None:
    """Prints a table for each of our three models and the peer's, and what a finer grid of the peer's gives."""
    plates, times = record["plates"], record["times_s"]
    output.line("contact temperature, degC: a 16 x 16 x 10 mm tip at 36 degC on plates at 24 degC")
    output.line(f"peer's figures published by {record['published_by']}; quoted, not measured again")
    moments = [f"{time:g} s" for time in times]
    for title, key in _TITLES.items():
        output.table(
            (title, "exact", *moments, *(f"off {moment}" for moment in moments)),
            [
                (
                    t["plate"],
                    f"{t['exact']:.2f}",
                    *(f"{value:.2f}" for value in t[key]),
                    *(f"{value - t['exact']:+.2f}" for value in t[key]),
                )
                for t in plates
            ],
        )
        output.line()
    output.line("mean of the tip's first millimetre at 5 s, degC, exact and peer (1 x 1 x 10 grid, quoted)")
    for t in plates:
        if t["plate"] in record["peer_first_millimetre"]:
            quoted = record["peer_first_millimetre"][t["plate"]]
            output.line(f"  {t['plate']}: {t['first_millimetre']:.2f}, peer {quoted:.2f}")
    metal, (exact, computed) = plates[-1]["plate"], plates[-1]["heat"]
    output.line(
        f"heat lost on {metal} in 5 s, kJ/m2: exact {exact / 1e3:.1f}, ours {computed / 1e3:.1f}, "
        f"peer {record['peer_heat_J_per_m2'][metal] / 1e3:.0f} (quoted)"
    )
