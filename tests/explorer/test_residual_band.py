"""What laws leave in a follower: a band that is dragged, a measured spectrum that is dropped, the law made for both."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from optlaws import Problem, read_spectrum, residual_vibration, response_spectrum, synthesize
from tests.explorer.talk import OPTIMAL, Server
from tests.explorer.test_page import go, saves, settle

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

SHAKER = "Hz,amplitude\n28,0.1\n30,0.3\n32,1\n34,0.4\n38,0.2\n"
PAIRS = [[28.0, 0.1], [30.0, 0.3], [32.0, 1.0], [34.0, 0.4], [38.0, 0.2]]


def test_peaks_and_the_greatest_in_a_band_are_the_library_s(served: Server, tmp_path: Path) -> None:
    law = synthesize(Problem(order=4, B=1.7)).law
    (tmp_path / "shaker.csv").write_text(SHAKER, "utf-8")
    measured = read_spectrum(tmp_path / "shaker.csv", duration="0.1 s")
    weighed = {"spectrum": PAIRS, "duration": "0.1 s"}
    for asked, constant in (
        ({"band": [18.0, 22.0]}, residual_vibration(frequency=(18, 22), damping=0.02)),
        (weighed, residual_vibration(spectrum=measured, damping=0.02)),
        (
            {**weighed, "band": [18.0, 22.0]},
            residual_vibration(spectrum=measured, frequency=(18, 22), damping=0.02),
        ),
    ):
        answer = served.ask("residual", {"laws": [OPTIMAL], "damping": 0.02, **asked})
        assert answer["laws"][0]["band"]["value"] == constant.peak(law).value
        assert answer["constant"] == str(constant)
    (peaks,) = answer["panels"][1]["series"]
    curves = response_spectrum(law, np.array(peaks["at"]), 0.02)
    assert peaks["values"] == pytest.approx(curves.peak_acceleration.tolist(), abs=1e-5)


def test_a_spectrum_of_many_lines_counts_whole(served: Server) -> None:
    nu = np.linspace(5.0, 60.0, 800)
    sizes = np.exp(0.3 * np.random.default_rng(1).normal(size=800)) / (1.0 + (nu - 20.0) ** 2)
    pairs = np.column_stack([nu, sizes.round(4)])
    assert served.ask("spectrum", {"laws": [OPTIMAL], "spectrum": pairs.tolist()}) == {"seconds": None}
    (left,) = served.ask("residual", {"laws": [OPTIMAL], "spectrum": pairs.tolist()})["laws"]
    law = synthesize(Problem(order=4, B=1.7)).law
    assert left["band"]["value"] == residual_vibration(spectrum=pairs).value(law)
    formula = f"residual(spectrum='{{{', '.join(f'{at:.5g}: {size:g}' for at, size in pairs)}}}')"
    bound = {"problem": OPTIMAL["problem"] | {"bounds": {formula: [0, 0.5 * left["band"]["value"]]}}}
    (view,) = served.ask("laws", {"laws": [bound]})["laws"]
    assert "optimal" in str(view["trust"])
    falling = served.ask("spectrum", {"laws": [OPTIMAL], "spectrum": [[2.0, 1.0], [1.0, 1.0]]})
    assert "above 0 and increasing, got [2.0, 1.0]" in falling["error"]


def test_a_formula_that_names_a_file_is_refused(served: Server) -> None:
    law: dict[str, Any] = {"problem": {"order": 4, "bounds": {"residual(spectrum='{/etc/hostname}')": [0, 1]}}}
    (view,) = served.ask("laws", {"laws": [law]})["laws"]
    assert "the page reads none" in view["refused"]["reason"]


def test_a_law_is_made_for_the_band_and_for_a_spectrum(page: Page, served: Server) -> None:
    go(page, served.link(laws=[OPTIMAL, {"name": "modified sine"}], picture="residual", damping=0.02))
    page.get_by_role("button", name="band", exact=True).click()
    settle(page)
    words = page.locator("#words")
    asked = {"laws": [OPTIMAL], "damping": 0.02, "band": [18, 22]}
    (left,) = served.ask("residual", asked)["laws"]
    assert f"in the band 18 to 22: A {left['band']['text']} at {left['band']['at']}" in words.inner_text()
    page.get_by_label("Greatest residual acceleration in the band: bounded").check()
    settle(page)
    assert "proven optimal" in page.locator("#trust").inner_text()
    most = page.get_by_label("Greatest residual acceleration in the band, number")
    assert float(most.input_value()) == pytest.approx(0.5 * left["band"]["value"], rel=1e-2)
    assert page.locator("#residual g > .zone").count() == 1
    # the band is moved by keys as by the pointer, and the law follows
    page.get_by_label("Where band ends and above begins").focus()
    page.keyboard.press("PageUp")
    settle(page)
    bound = {"residual(frequency=(18, 23), damping=0.02)": [0, float(most.input_value())]}
    robust = {"problem": OPTIMAL["problem"] | {"bounds": bound}}
    (view,) = served.ask("laws", {"laws": [robust]})["laws"]
    assert page.locator("#table [data-constant=C]").first.inner_text() == view["constants"][1]["text"]
    handed = page.evaluate_handle(
        "text => { const held = new DataTransfer(); held.items.add(new File([text], 'shaker.csv')); return held; }",
        SHAKER,
    )
    page.dispatch_event("#residual", "drop", {"dataTransfer": handed})
    page.locator(".spectrum", has_text="shaker.csv").wait_for()
    settle(page)
    assert "greatest, weighed, in the band 18 to 23" in words.inner_text()
    assert page.locator("#residual .curve").count() == 3
    saved = tomllib.loads(saves(page, "problem"))["problem"]["bounds"]
    assert [name.startswith("residual(spectrum='{") for name in saved] == [True]
    page.set_viewport_size({"width": 390, "height": 844})
    curves, fields = page.locator("#residual").bounding_box(), page.locator("#follower").bounding_box()
    assert curves is not None
    assert fields is not None
    assert curves["y"] + curves["height"] <= fields["y"] + 1.0
    page.set_viewport_size({"width": 1280, "height": 800})
    page.get_by_label("Take the spectrum away").click()
    page.get_by_role("button", name="band", exact=True).click()
    settle(page)
    assert page.locator("#table [data-constant=C]").first.inner_text() == told_of(served)


def told_of(served: Server) -> str:
    """The least C without a bound in any band."""
    (view,) = served.ask("laws", {"laws": [OPTIMAL]})["laws"]
    text: str = view["constants"][1]["text"]
    return text
