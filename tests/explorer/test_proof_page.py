"""Proofs that are checked in a real browser: of files, offline, and of what the explorer shows."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from optlaws import Chebyshev, FastestMove, Problem, synthesize
from tests.explorer.talk import Server
from tests.explorer.test_page import go, settle
from tests.internals.explorer import CycleRequest, cycle_view, example, fastest_view

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page


def test_a_file_is_checked_on_the_page(page: Page, served: Server, tmp_path: Path) -> None:
    solution = synthesize(Problem(B=1.859, order=3, basis=Chebyshev(5))).to_dict()
    false = solution | {"objective": solution["objective"] * 1.001}
    for name, data in (("law.json", solution), ("false.json", false), ("text.json", {"text": 1})):
        (tmp_path / name).write_text(json.dumps(data), encoding="utf8")
    go(page, f"http://{served.host}/#view=%22proof%22")

    def verdict(name: str) -> str:
        page.get_by_label("File with a proof").set_input_files(tmp_path / name)
        page.locator("body[data-work=settled] #proof-verdict", has_text=name).wait_for(timeout=60_000)
        return page.locator("#proof-verdict").inner_text()

    assert verdict("law.json").startswith("proven law.json: 15 proven")
    assert page.locator(".claims tbody tr").count() == 15
    assert verdict("false.json").startswith("not proven false.json")
    assert "nothing in it is a certificate" in verdict("text.json")


def test_what_is_shown_is_checked_by_the_second_checker(page: Page, served: Server) -> None:
    go(page, f"http://{served.host}/")
    page.get_by_role("button", name="check this proof").click()
    page.locator("#proof-verdict .word.good").wait_for()
    settle(page)
    assert "checked on this page in" in page.locator("#proof-verdict").inner_text()
    first = page.locator("#proof-claims tbody tr").first.inner_text()
    solution = synthesize(Problem(order=4, B=1.7))
    assert float(first.split()[2]) == pytest.approx(solution.lower_bound, rel=1e-11)
    assert page.get_by_role("button", name="Undo").is_disabled()  # a look at another view is no step
    page.locator("#views [data-key=laws]").click()
    settle(page)
    assert "proven optimal" in page.locator("#trust").inner_text()


def test_a_dropped_file_is_checked_when_the_server_is_away(page: Page, served: Server, tmp_path: Path) -> None:
    law = tmp_path / "law.json"
    law.write_text(json.dumps(synthesize(Problem(B=1.859, order=3, basis=Chebyshev(5))).to_dict()), "utf-8")
    go(page, f"http://{served.host}/")
    page.wait_for_load_state("networkidle")  # nothing of the page waits for its icon
    page.locator("#views [data-key=proof]").click()
    page.get_by_text("files are checked without the server").wait_for()
    settle(page)
    page.context.set_offline(offline=True)
    page.evaluate(
        """text => {
          const files = new DataTransfer();
          files.items.add(new File([text], "law.json"));
          document.body.dispatchEvent(new DragEvent("drop", {dataTransfer: files, bubbles: true, cancelable: true}));
        }""",
        law.read_text("utf-8"),
    )
    page.locator("#proof-verdict", has_text="law.json: 15 proven").wait_for(timeout=60_000)


def test_proofs_of_a_motion_are_those_of_its_laws(served: Server) -> None:
    study = {"study": example()}
    answered = served.ask("save", {"kind": "proof", "view": "cycle", "request": study})
    solutions = cycle_view.cycle(CycleRequest(study=example())).solutions
    bounds = [stored["certificate"]["bound"] for stored in json.loads(answered["text"])["solutions"]]
    assert bounds == pytest.approx([solution.certificate.bound for solution in solutions], rel=1e-12)
    moves: dict[str, Any] = {"study": fastest_view.example()}
    question = {"kind": "proof", "view": "fastest", "request": moves}
    stored = json.loads(served.ask("save", question)["text"])
    least = fastest_view.fastest_of(CycleRequest(**moves))
    assert isinstance(least, FastestMove)
    assert stored["duration"] == least.duration
    assert stored["proofs"] == json.loads(json.dumps(least.to_dict()["proofs"]))
