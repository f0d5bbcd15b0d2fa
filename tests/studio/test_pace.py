"""How quick the page is: prints frames a second, and milliseconds from a slider to the screen; decides only that there
are some. `make test-view TEST_FLAGS="-s -k quick"`, on a machine that does nothing else."""

import os
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

pytest.importorskip("websockets", reason="the extra view is not installed")
pytest.importorskip("playwright.sync_api", reason="playwright is not installed: make test-view")

from .test_page import chromium, until, url, visit, wait  # noqa: F401

SECONDS, MOVES = 4.0, 16

FRAMES = """(seconds) => new Promise((done) => {
  let drawn = 0;
  const { pace } = studio.scene, { begin } = pace;
  pace.begin = (now) => { drawn++; begin.call(pace, now); };
  const before = [studio.frames, studio.shown, performance.now()];
  setTimeout(() => {
    pace.begin = begin;
    const passed = (performance.now() - before[2]) / 1000;
    done([studio.frames - before[0], studio.shown - before[1], drawn].map((count) => count / passed));
  }, 1000 * seconds);
})"""
MOVE = """(value) => {
  const slider = document.getElementById("range-opening");
  slider.value = value;
  for (const kind of ["input", "change"]) slider.dispatchEvent(new Event(kind));
}"""


@pytest.mark.usefixtures("chromium")
def test_how_quick_it_is(visit: Callable[..., Any], url: str) -> None:  # noqa: F811
    page = visit(url)
    until(page, 1.0)
    page.get_by_text("Hand", exact=True).click()
    page.locator("#range-opening").wait_for()
    page.wait_for_timeout(2000)  # the picture has found its detail
    page.evaluate("studio.link.latencies.length = 0")
    arrived, shown, drawn = page.evaluate(FRAMES, SECONDS)
    for number in range(MOVES):
        page.evaluate(MOVE, 0.06 + 0.001 * number)
        wait(page, f"studio.link.latencies.length > {number}")
        page.wait_for_timeout(80 + 37 * (number % 7))  # not in step with the frames
    spent = np.array(page.evaluate("studio.link.latencies"))
    print(
        f"\n3-D {'in software' if page.evaluate('studio.scene.slow') else 'by a graphics card'}, "
        f"detail {page.evaluate('studio.scene.pace.detail')}, load {os.getloadavg()[0]:.1f}: "
        f"{arrived:.1f} frames/s arrive, {shown:.1f} are shown, 3-D in {drawn:.1f} of them; from slider to screen "
        f"{np.median(spent):.0f} ms (median), {np.quantile(spent, 0.95):.0f} ms (95 %)"
    )
    assert arrived > 0 and shown > 0 and drawn > 0 and len(spent) >= MOVES
