"""The demonstration page's style sheet, for light and dark screens and for narrow ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.colors import to_hex, to_rgb

from thermograsp.figures import ordered_colors

_SHEET = """
:root { color-scheme: light dark; --paper:#fcfbf9; --ink:#1d2025; --soft:#666c75; --faint:#a3a8af;
  --line:#e5e3de; --press:#3d1d9c; %LIGHT% }
@media (prefers-color-scheme: dark) {
  :root { --paper:#14161a; --ink:#eceae5; --soft:#a0a5ae; --faint:#6c727b; --line:#2b2f36; --press:#b3a1ff; %DARK% }
}
* { box-sizing: border-box; }
body { margin:0; background:var(--paper); color:var(--ink); line-height:1.55; font-size:16px;
  font-family: Inter, system-ui, -apple-system, "Segoe UI", "Helvetica Neue", "Liberation Sans", Arial, sans-serif; }
main { max-width:1240px; margin:0 auto; padding:56px 32px 72px; }
header { max-width:760px; margin-bottom:44px; }
h1 { font:600 40px/1.14 "Iowan Old Style", Charter, "Bitstream Charter", "Sitka Text", Cambria, Georgia,
  "Liberation Serif", serif; letter-spacing:-.012em; margin:0 0 16px; text-wrap:balance; }
.lede { font-size:18px; color:var(--soft); margin:0; text-wrap:pretty; }
h2 { font-size:16px; font-weight:650; margin:0; letter-spacing:-.003em; }
.note { color:var(--soft); font-size:14px; margin:2px 0 0; text-wrap:pretty; }
section { margin-top:56px; }
.pair { display:grid; grid-template-columns:repeat(auto-fit, minmax(min(100%,460px),1fr)); gap:40px 48px; }
figure { margin:0; min-width:0; }
figcaption { margin-bottom:14px; }
svg { display:block; width:100%; height:auto; overflow:visible; font-family:inherit; }
.grid { stroke:var(--line); stroke-width:1; }
.tick { fill:var(--soft); font-size:12px; font-variant-numeric:tabular-nums; }
line.mark { stroke:var(--faint); stroke-width:1; stroke-dasharray:1.5 3; }
text.mark { fill:var(--soft); font-size:11.5px; }
.curve path { fill:none; stroke:var(--c); stroke-width:2; stroke-linejoin:round; stroke-linecap:round; }
.curve .hair { stroke-width:1; opacity:.55; }
.curve text { fill:var(--c); font-size:12.5px; font-weight:550; }
.curve { transition:opacity .15s; }
svg:has(.curve:hover) .curve:not(:hover) { opacity:.18; }
.film { display:grid; grid-template-columns:repeat(%STILLS%, 1fr); gap:14px; margin-top:16px; }
.film img { display:block; width:100%; border-radius:6px; }
.film .when { font-size:13px; color:var(--soft); margin:7px 0 5px; font-variant-numeric:tabular-nums; }
.across { display:flex; height:22px; border-radius:4px; overflow:hidden; }
.across i { flex:1; display:block; }
.across i.wide { flex:3; }
.reads { font-size:12px; color:var(--soft); margin-top:4px; font-variant-numeric:tabular-nums; display:flex;
  justify-content:space-between; }
.maps { display:grid; grid-template-columns:repeat(auto-fit, minmax(150px,1fr)); gap:18px 22px; margin-top:16px; }
.maps figcaption { margin:6px 0 0; }
.press { fill:var(--press); shape-rendering:crispEdges; }
.pad { fill:none; stroke:var(--faint); stroke-width:.12; }
.face { fill:none; stroke:var(--soft); stroke-width:.1; stroke-dasharray:.4 .3; }
.key { display:flex; gap:12px; align-items:center; margin-top:18px; font-size:13px; color:var(--soft); flex-wrap:wrap; }
.key .bar { width:240px; height:10px; border-radius:5px; }
.scroll { overflow-x:auto; margin-top:14px; }
table { border-collapse:collapse; width:100%; font-size:14px; font-variant-numeric:tabular-nums; white-space:nowrap; }
th, td { padding:7px 0 7px 14px; text-align:right; border-bottom:1px solid var(--line); }
th { font-weight:500; color:var(--soft); vertical-align:bottom; line-height:1.3; font-size:13px; }
th.group { text-align:center; color:var(--ink); font-weight:650; padding-bottom:3px; }
th small { font-size:12px; color:var(--faint); display:block; }
th:first-child, td:first-child { text-align:left; padding-left:0; }
td.first, th.first { padding-left:40px; }
td.strong { font-weight:650; }
.dot { display:inline-block; width:10px; height:10px; border-radius:50%; background:var(--c); margin-right:9px; }
dl { display:grid; grid-template-columns:max-content 1fr; gap:5px 24px; font-size:14px; margin:14px 0 0; }
dt { color:var(--soft); } dd { margin:0; min-width:0; overflow-wrap:anywhere; }
code { font-family:ui-monospace, "SF Mono", Menlo, Consolas, "Liberation Mono", monospace; font-size:.92em; }
@media (max-width:820px) { main { padding:32px 18px 48px; } h1 { font-size:31px; }
  .film { grid-template-columns:repeat(3,1fr); } }
@media print { main { max-width:none; padding:0; } }
"""


def style_sheet(count: int, stills: int) -> str:
    """CSS for a page of `count` materials, whose classes m0, m1, ... set the colour --c, and a film of `stills`."""
    light = ordered_colors(count)
    # The house's colours end in a blue too deep for a dark page: towards that end they are mixed with white.
    dark = [
        _lighter(color, share) for color, share in zip(light, np.linspace(0.05, 0.55, count), strict=True)
    ]
    sheet = _SHEET.replace("%LIGHT%", _variables(light)).replace("%DARK%", _variables(dark))
    classes = "".join(f".m{i} {{ --c:var(--m{i}); }}\n" for i in range(count))
    return sheet.replace("%STILLS%", str(max(stills, 1))) + classes


def _variables(colors: Sequence[str]) -> str:
    return " ".join(f"--m{i}:{color};" for i, color in enumerate(colors))


def _lighter(color: str, share: float) -> str:
    red, green, blue = (part * (1 - share) + share for part in to_rgb(color))
    return to_hex((red, green, blue))
