"""The studio's page in headless Chromium: what a visitor sees and does. `make test-view` installs what it needs."""

import io
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

pytest.importorskip("websockets", reason="the extra view is not installed")
sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: make test-view")

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
if CHROMIUM is None:
    pytest.skip("there is no chromium: apt-get install chromium", allow_module_level=True)

ARGUMENTS = [
    "--no-sandbox",  # as root in a container
    "--enable-unsafe-swiftshader",  # WebGL without a graphics card
    "--disable-background-networking",
    "--disable-component-update",
]
PATIENCE = 240_000  # ms, on a machine that is busy with other things
DESKTOP, PHONE = {"width": 1280, "height": 720}, {"width": 390, "height": 844}
TIME = "studio.memory.time.at(-1) ?? 0"
HEADER = "time_s,voltage_left_V,voltage_right_V,temperature_drop_left_K"


os.environ["THERMOGRASP_TOKEN"] = "one-for-all-servers"  # as they come back under the same address


@contextmanager
def serving(port: int = 0) -> Iterator[tuple[subprocess.Popen[str], str]]:
    command = [sys.executable, "-m", "thermograsp", "view", "--json", "--port", str(port)]
    # What is started in the background ignores SIGINT, and so would its children.
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=heed)
    try:
        assert process.stdout is not None
        printed = ""
        while not printed.endswith("}\n"):
            line = process.stdout.readline()
            assert line, "the studio ended before it told its address"
            printed += line
        yield process, json.loads(printed)["url"]
    finally:
        process.kill()
        process.wait()


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    with serving() as (_, address):
        yield address


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture
def visit(chromium: Any) -> Iterator[Callable[..., Any]]:
    """Opens a page, live. At the end no page may have complained, but of a server that was taken away."""
    contexts, complaints = [], []

    def noted(message: Any) -> None:
        if (
            message.type in ("error", "warning")
            and "WebSocket" not in message.text
            and "GPU stall" not in message.text
        ):
            complaints.append(message.text)

    def do(address: str, size: dict[str, int] = DESKTOP) -> Any:
        context = chromium.new_context(viewport=size, accept_downloads=True)
        context.set_default_timeout(PATIENCE)
        contexts.append(context)
        page = context.new_page()
        page.on("console", noted)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(address)
        wait(page, "document.body.dataset.state === 'live'")
        return page

    yield do
    for context in contexts:
        context.close()
    assert complaints == []


def wait(page: Any, condition: str) -> None:
    """Until it holds. Asked from outside: Playwright's own way evaluates a string in the page, which must not."""
    deadline = time.monotonic() + PATIENCE / 1000
    while not page.evaluate(condition):
        assert time.monotonic() < deadline, condition
        page.wait_for_timeout(30)


def until(page: Any, seconds: float) -> None:
    """The grasp's clock has come that far."""
    wait(page, f"({TIME}) >= {seconds}")


def pixels_of(page: Any, what: str) -> np.ndarray:
    """(N, 3) what an element shows on the screen."""
    picture = Image.open(io.BytesIO(page.locator(what).screenshot())).convert("RGB")
    return np.asarray(picture).reshape(-1, 3).astype(int)


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_glass_is_grasped_and_the_curve_rises(visit: Any, url: str, size: dict[str, int]) -> None:
    page = visit(url, size)
    until(page, 2.0)
    at, left = np.array(page.evaluate("[studio.memory.time, studio.memory.rows[0][0]]"))
    assert left.max() > 3e-3 and abs(left[10]) < 1e-4
    assert (np.diff(left[(at > 0.6) & (at < 1.6)][::10]) > 0).all()
    assert page.locator("#names").inner_text().startswith("glass")
    curve = np.abs(pixels_of(page, "#voltage") - (0x0B, 0x62, 0xA8)).max(axis=1) < 30  # --first of studio.css
    assert curve.sum() > 100
    seen = pixels_of(page, "#scene")
    yellow = (seen[:, 0] > 200) & (seen[:, 1] > 150) & (seen[:, 2] < 140)  # a thermostat at 36 °C
    blue = (seen[:, 2] > seen[:, 0] + 50) & (seen[:, 2] > seen[:, 1] + 50)  # the object at 24 °C
    assert yellow.sum() > 20 and blue.sum() > 100 and len(np.unique(seen, axis=0)) > 500
    wait(page, "document.querySelector('#belief .true')?.textContent === 'glass'")
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    for name in ("play", "step", "again", "speed", "material", "mode", "csv", "force"):
        assert page.locator(f"#{name}").is_visible(), name


def test_material_mode_and_tolerance(visit: Any, url: str) -> None:
    page = visit(url)
    page.select_option("#material", "cotton")
    wait(page, "document.querySelector('#names p').textContent.startsWith('cotton')")
    fine = page.locator("#cost").inner_text()
    assert "states" in fine
    page.get_by_text("O mode").click()
    wait(page, "document.querySelector('#across').textContent.includes('element')")
    wait(page, "document.querySelector('#cost').title.includes('/0/')")  # no states of a sensor
    network = page.locator("#cost").get_attribute("title")
    page.locator("#range-tolerance").focus()
    page.keyboard.press("End")
    wait(page, "document.querySelector('#range-tolerance').nextSibling.textContent === '1 K'")
    wait(page, f"document.querySelector('#cost').title !== {network!r}")
    until(page, 0.8)


def test_two_materials_side_by_side_and_their_files(visit: Any, url: str) -> None:
    page = visit(url)
    page.select_option("#material", "aluminium")
    page.select_option("#other", "cotton")
    wait(page, "document.querySelectorAll('#names p').length === 2")
    until(page, 1.5)
    metal, cloth = (max(page.evaluate(f"studio.memory.rows[{row}][0]")) for row in range(2))
    assert metal > 5 * cloth > 0
    downloads = []
    page.on("download", lambda one: downloads.append(one))
    page.click("#csv")
    page.wait_for_timeout(300)
    while len(downloads) < 2:
        page.wait_for_timeout(100)
    assert sorted(one.suggested_filename for one in downloads) == ["aluminium_T.csv", "cotton_T.csv"]
    for one in downloads:
        assert Path(one.path()).read_text().startswith(HEADER)


def test_choices_made_while_a_grasp_is_prepared_stay(visit: Any, url: str) -> None:
    page = visit(url)
    for name in ("wood", "rubber"):  # the first one's scene comes when the second is already chosen
        page.select_option("#material", name)
        page.select_option("#other", "cotton")
    wait(
        page,
        "[...document.querySelectorAll('#names p')].map((p) => p.firstChild.data).join() === 'rubber,cotton'",
    )
    assert page.locator("#material").input_value() == "rubber"
    assert page.locator("#other").input_value() == "cotton"


def test_pause_step_speed_and_again(visit: Any, url: str) -> None:
    page = visit(url)
    page.click("#play")
    wait(page, "document.querySelector('#play').textContent === 'Play'")
    wait(page, "document.querySelector('#pace').textContent === 'paused'")
    held = page.evaluate(TIME)
    page.wait_for_timeout(300)
    assert page.evaluate(TIME) == held
    page.click("#step")
    wait(page, f"Math.abs(({TIME}) - {held + 0.02}) < 1e-6")
    page.select_option("#speed", "4")
    page.click("#play")
    until(page, held + 1.5)
    page.click("#again")
    wait(page, f"({TIME}) < 1")


def test_a_thing_that_has_its_own_material_and_temperature(visit: Any, url: str) -> None:
    page = visit(url)
    seen = "window.seen = getComputedStyle(document.querySelector('#scene')).visibility"
    page.evaluate(
        "new MutationObserver(() => { if (document.body.dataset.state === 'busy') "
        + seen
        + "; }).observe(document.body, { attributes: true })"
    )
    page.select_option("#shape", "toy_block")
    wait(page, "document.querySelector('#names p').textContent.startsWith('toy block')")
    wait(page, "document.querySelector('#busy').hidden")
    assert page.evaluate("window.seen") == "hidden"  # no glass while it was prepared
    until(page, 0.3)
    assert page.locator("#cost").inner_text().startswith("Heat model: a network of ")
    assert not page.locator("#material").is_visible() and page.locator("#shape").is_visible()
    for name in ("#shape", "#range-roughness", "#range-ambient"):  # laid out below their headings
        box = page.locator(name).bounding_box()
        assert box["x"] + box["width"] < 262, name


def test_the_gripper_by_hand(visit: Any, url: str) -> None:
    page = visit(url)
    page.get_by_text("Hand", exact=True).click()
    page.locator("#range-opening").focus()
    page.keyboard.press("End")
    page.locator("#range-height").focus()
    page.keyboard.press("Home")  # it stood where the script had lifted to
    for _ in range(6):
        page.keyboard.press("ArrowRight")
    wait(page, "document.querySelector('#range-height').nextSibling.textContent === '30 mm'")
    wait(page, "['apart', 'dropped'].includes(document.querySelector('#names small').textContent)")
    page.locator("#scene").focus()
    page.keyboard.press("ArrowLeft")
    box = page.locator("#scene").bounding_box()
    page.mouse.move(box["x"] + 50, box["y"] + 50)
    page.mouse.down()
    page.mouse.move(box["x"] + 120, box["y"] + 70)
    page.mouse.up()
    page.mouse.wheel(0, 200)


def test_two_tabs_do_not_disturb_each_other(visit: Any, url: str) -> None:
    first, second = visit(url), visit(url)
    first.click("#play")
    wait(first, "document.querySelector('#pace').textContent === 'paused'")
    second.select_option("#material", "wood")
    wait(second, "document.querySelector('#names p').textContent.startsWith('wood')")
    until(second, 1.0)
    assert first.locator("#names").inner_text().startswith("glass")
    assert first.locator("#play").inner_text() == "Play" and second.locator("#play").inner_text() == "Pause"


def test_what_cannot_be_is_told(visit: Any, url: str) -> None:
    page = visit(url)
    page.evaluate("studio.link.send('choose', {width: 9})")
    page.locator("#problem").wait_for(state="visible")
    assert page.locator("#problem").inner_text() == "Width must be 0.015 to 0.07, got 9"


def test_a_server_that_is_killed_and_comes_back(visit: Any) -> None:
    with serving() as (process, address):
        page = visit(address)
        page.select_option("#material", "wood")
        wait(page, "document.querySelector('#names p').textContent.startsWith('wood')")
        process.kill()
        page.locator("#lost").wait_for(state="visible")
        assert page.locator("#lost-title").inner_text() == "The connection is lost"
        assert "thermograsp view" in page.locator("#lost-text").inner_text()
        page.click("#retry")
        page.locator("#lost").wait_for(state="visible")
    with serving(int(address.split(":")[2].split("/")[0])):
        page.click("#retry")
        page.locator("#lost").wait_for(state="hidden")
        wait(page, "document.body.dataset.state === 'live'")
        wait(page, "document.querySelector('#names p').textContent.startsWith('wood')")  # as before


def test_a_studio_that_is_ended(visit: Any) -> None:
    with serving() as (process, address):
        page = visit(address)
        process.send_signal(signal.SIGINT)
        page.locator("#lost").wait_for(state="visible")
        assert page.locator("#lost-title").inner_text() == "The studio has stopped"
        assert process.wait(PATIENCE) == 130


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="finds processes in /proc")
def test_a_simulation_that_is_killed(visit: Any) -> None:
    with serving() as (process, address):
        page = visit(address)
        for worker in (leaf for child in children(process.pid) for leaf in children(child)):
            os.kill(worker, signal.SIGKILL)
        page.locator("#lost").wait_for(state="visible")
        assert page.locator("#lost-title").inner_text() == "The simulation has ended"
        assert "unexpectedly" in page.locator("#lost-text").inner_text()
        page.click("#retry")
        page.locator("#lost").wait_for(state="hidden")
        until(page, 0.5)


def children(pid: int) -> list[int]:
    return [
        int(child)
        for task in Path(f"/proc/{pid}/task").iterdir()
        for child in (task / "children").read_text().split()
    ]
