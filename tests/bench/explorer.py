"""What a drag costs in the explorer: from the input to the paint that shows its law, in a real browser.

Run it with `python -m tests.bench.explorer`; `make bench` ends with it where there are playwright and chromium.
"""

import shutil
from statistics import median, quantiles
from threading import Thread
from time import perf_counter

from rich.console import Console
from rich.table import Table

STEPS = 60
FIRST = 1.4567
AIM, WORST = 30.0, 60.0
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"]
#: marks that the page sets: the last input, and the paint after an answer
MEASURED = """() => {
  const last = (name) => performance.getEntriesByName(name).at(-1)?.startTime ?? 0;
  return [last("input"), last("painted")];
}"""


def measured(degree: int) -> tuple[list[float], list[float]]:
    """Milliseconds from each input to its paint, and of the server's answer alone."""
    from playwright.sync_api import sync_playwright

    from tests.internals.explorer import LawRequest, LawsRequest, answer, opened, server, start

    first = start(None)
    # every step is a law that was not solved before
    first["laws"][0]["problem"] |= {"degree": degree, "B": FIRST}
    with opened(0) as listening, sync_playwright() as playwright:
        running = server(first)
        thread = Thread(target=running.run, kwargs={"sockets": [listening]}, daemon=True)
        thread.start()
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(f"http://127.0.0.1:{listening.getsockname()[1]}/")
        settled = page.locator("body[data-work=settled]")
        settled.wait_for()
        page.locator(".handle").focus()
        spent, answered = [], []
        for step in range(STEPS):
            page.keyboard.press("ArrowRight")
            settled.wait_for()
            page.wait_for_timeout(40)
            began, painted = page.evaluate(MEASURED)
            spent.append(painted - began)
            entries = {"order": 4, "degree": degree, "B": FIRST + 0.00123 + 0.01 * step}
            start_of = perf_counter()
            answer(LawsRequest(laws=[LawRequest(problem=entries, weights={"C": 1.0})]))
            answered.append(1e3 * (perf_counter() - start_of))
        browser.close()
        running.should_exit = True
        thread.join()
    return spent[5:], answered[5:]


def main() -> None:
    """Measure and print; say so where there is no browser."""
    console = Console(width=120)
    try:
        import playwright  # noqa: F401
    except ModuleNotFoundError:
        console.print("explorer: not measured, playwright is not installed")
        return
    if shutil.which("chromium") is None:
        console.print("explorer: not measured, there is no chromium")
        return
    table = Table(
        "degree", "input to paint, ms", "95th percentile", "the answer alone", "aims", title="explorer (* missed)"
    )
    for degree in (9, 19):
        spent, answered = measured(degree)
        middle, worst = median(spent), quantiles(spent, n=20)[-1]
        missed = " *" if middle > AIM or worst > WORST else ""
        cells = [f"{middle:.1f}{missed}", f"{worst:.1f}", f"{median(answered):.1f}", f"{AIM:g}, {WORST:g}"]
        table.add_row(str(degree), *cells)
    console.print(table)


if __name__ == "__main__":
    main()
