"""What a drag and the first page cost in the explorer, in a real browser: from the input to the paint of its law.

Run it with `python -m tests.bench.explorer`; `make bench` ends with it where there are playwright and chromium. The
server is a process of its own, and nothing looks at the page while it is dragged.
"""

import subprocess
import sys
from statistics import median, quantiles
from urllib.parse import urlencode

from rich.console import Console
from rich.table import Table

from tests.explorer.conftest import CHROMIUM, FLAGS

STEPS, FIRST_STEPS = 60, 5
FIRST = 1.4567
AIM, WORST = 30.0, 60.0
LOADED = 500.0
PIXELS, APART = 2.5, 200
SERVER = "import sys; from tests.internals.explorer import ADDRESS, opened, server, start\n\
with opened(0) as listening: print(listening.getsockname()[1], flush=True); server(start(None)).run([listening])"
#: notes, at each paint after an answer, when its input came, its question was sent, and its answer was there
WATCH = """() => {
  window.spent = [];
  const last = (name) => performance.getEntriesByName(name).at(-1)?.startTime ?? 0;
  new PerformanceObserver((list) => {
    const asked = performance.getEntriesByType("resource").findLast(({ name }) => name.includes("api/laws"));
    const times = [last("input"), asked.requestStart, asked.responseEnd, last("painted")];
    if (list.getEntriesByName("painted").length) spent.push(times.slice(1).map((time, i) => time - times[i]));
    performance.clearResourceTimings();
  }).observe({ entryTypes: ["mark"] });
}"""
INTERACTIVE = """() => new Promise((resolve) => {
  const shown = () => document.body.dataset.work === "settled" && document.querySelector("#curves .line");
  const done = () => shown() && resolve(performance.now());
  new MutationObserver(done).observe(document.documentElement, { subtree: true, childList: true, attributes: true });
  done();
})"""


def measured(degree: int) -> tuple[list[list[float]], float]:
    """Milliseconds of each step of a drag, by its parts; and of the first page, until its first law is shown."""
    from playwright.sync_api import sync_playwright

    # every step is a law that was not solved before
    law = f'{{"problem": {{"order": 4, "degree": {degree}, "B": {FIRST}}}}}'
    with subprocess.Popen([sys.executable, "-c", SERVER], stdout=subprocess.PIPE, text=True) as serving:
        assert serving.stdout is not None
        address = f"http://127.0.0.1:{serving.stdout.readline().strip()}/#{urlencode({'law': law})}"
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS.split())
            for _ in range(2):  # the processes of the server are ready when the second one comes
                page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
                page.goto(address, wait_until="commit")
                page.wait_for_selector("main")
                loaded = page.evaluate(INTERACTIVE)
                page.wait_for_timeout(10 * APART)
            page.evaluate(WATCH)
            box = page.locator(".handle").first.bounding_box()
            assert box is not None
            x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
            page.mouse.move(x, y)
            page.mouse.down()
            for step in range(STEPS):
                page.mouse.move(x + PIXELS * (step + 1), y)
                page.wait_for_timeout(APART)
            page.mouse.up()
            spent: list[list[float]] = page.evaluate("() => spent")
            browser.close()
        serving.terminate()
    return spent[FIRST_STEPS:], loaded


def main() -> None:
    """Measure and print; say so where there is no browser."""
    console = Console(width=120)
    try:
        import playwright  # noqa: F401
    except ModuleNotFoundError:
        console.print("explorer: not measured, playwright is not installed")
        return
    if CHROMIUM is None:
        console.print("explorer: not measured, there is no chromium")
        return
    heads = ("degree", "input to paint, ms", "95th percentile", "aims", "to the question", "the answer", "to the paint")
    table = Table(*heads, "first page, ms", title="explorer (* missed)")
    for degree in (9, 19):
        spent, loaded = measured(degree)
        whole = [sum(parts) for parts in spent]
        middle, worst = median(whole), quantiles(whole, n=20)[-1]
        cells = [f"{middle:.1f}{' *' if middle > AIM else ''}", f"{worst:.1f}{' *' if worst > WORST else ''}"]
        parts = [f"{median(part):.1f}" for part in zip(*spent, strict=True)]
        table.add_row(
            str(degree), *cells, f"{AIM:g}, {WORST:g}", *parts, f"{loaded:.0f}{' *' if loaded > LOADED else ''}"
        )
    console.print(table)


if __name__ == "__main__":
    main()
