"""The page on which a file of proofs is checked: offline, in a real browser."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from optlaws import Chebyshev, Problem, synthesize
from tests.explorer.talk import Server

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page


def test_a_file_is_checked_on_the_page_without_the_server(page: Page, served: Server, tmp_path: Path) -> None:
    solution = synthesize(Problem(B=1.859, order=3, basis=Chebyshev(5))).to_dict()
    false = solution | {"objective": solution["objective"] * 1.001}
    for name, data in (("law.json", solution), ("false.json", false), ("text.json", {"text": 1})):
        (tmp_path / name).write_text(json.dumps(data), encoding="utf8")
    page.goto(f"http://{served.host}/")
    page.get_by_role("link", name="Check a proof").click()
    page.locator("#proof-file").wait_for()
    page.context.set_offline(offline=False)

    def verdict(name: str) -> str:
        page.locator("#proof-file").set_input_files(tmp_path / name)
        page.locator("body[data-work=ready] #verdict", has_text=name).wait_for(timeout=15_000)
        return page.locator("#verdict").inner_text()

    assert verdict("law.json").startswith("proven law.json: 15 proven")
    assert page.locator(".claims tbody tr").count() == 15
    page.screenshot(path=tmp_path / "proof.png")
    assert verdict("false.json").startswith("not proven false.json")
    assert "nothing in it is a certificate" in verdict("text.json")
