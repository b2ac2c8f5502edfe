"""The table of an old cam in the page: what it is, better laws near it, and the files of both."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from optlaws import Cycle, catalogue, read_cycle_table
from optlaws.verification import verify
from tests.documents import ROOT
from tests.explorer.talk import Server, written
from tests.explorer.test_page import go, settle
from tests.internals.explorer import CycleRequest, OpenRequest, old_cam_view, opened_file, start

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

REAL = ROOT / "problems" / "data" / "rtmotion_cam.csv"
ANGLES = np.arange(0.0, 361.0, 6.0)
LIFT = 35.0 * catalogue["modified sine"].law(np.clip(ANGLES / 120.0, 0.0, 1.0))


def text_of(heights: Any) -> str:
    """A table of one rise and its dwell."""
    lines = [f"{angle:.0f};{height:.3f}" for angle, height in zip(ANGLES, heights, strict=True)]
    return "\n".join(["degree;mm", *lines]) + "\n"


STUDY = {"file": "turn.csv", "text": text_of(LIFT), "speed": "200 rpm"}


@pytest.fixture(scope="module")
def turn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("old") / "turn.csv"
    file.write_text(STUDY["text"], "utf-8")
    return file


def test_a_table_is_what_the_library_reads(served: Server, turn: Path) -> None:
    shown, table = served.ask("old", {"study": STUDY}), read_cycle_table(turn)
    rows = [[part.kind, part.start, part.stop] for part in table.stretches]
    assert [row[:3] for row in shown["tables"][0]["rows"]] == rows
    assert written(shown["tables"][0]["rows"][0][4]) == table.law_in_words(table.stretches[0])
    assert written(shown["trust"]["facts"][0]) == f"within {table.room:.3g} mm of the points"
    off = next(one for one in shown["panels"][1]["series"] if one["name"] == "points")
    assert off["values"] == pytest.approx(table.heights - table.at(table.places), abs=1e-7)
    for panel, nu in zip(shown["panels"][2:], (1, 2, 3), strict=True):
        peaks = [gain.old[nu - 1] for gain in table.gains(table)]
        assert [abs(mark["value"]) for mark in panel["peaks"]] == pytest.approx(peaks)
        (law,) = panel["series"]
        at = dict(zip(law["at"], law["values"], strict=True))
        assert all(at[mark["at"]] == pytest.approx(mark["value"], abs=1e-7) for mark in panel["peaks"])


@pytest.mark.long
def test_a_noisy_table_says_its_noise_and_its_seam(served: Server) -> None:
    study = {"text": REAL.read_text("utf-8")}
    shown, table = served.ask("old", {"study": study}), read_cycle_table(REAL)
    facts = " ".join(map(written, shown["trust"]["facts"]))
    assert (shown["trust"]["word"], table.off[0] < table.room, "off the point" in facts) == ("read", True, False)
    assert f"scatter by {table.scatter:.2g} mm" in facts
    assert f"{table.seam:.3g} mm from the first" in facts
    near = table.off[0] / 4.0
    shown, table = (
        served.ask("old", {"study": study | {"room": near}}),
        read_cycle_table(REAL, tolerance=near),
    )
    facts = " ".join(map(written, shown["trust"]["facts"]))
    assert shown["trust"]["word"] == "off a point"
    assert f"{table.off[0]:.3g} mm off the point at {table.off[1]:.6g} turn" in facts


def test_better_laws_are_the_library_s_and_so_are_their_files(served: Server, turn: Path) -> None:
    study = STUDY | {"within": 0.1}
    table = read_cycle_table(turn)
    better = table.bettered(0.1)
    # as it is dragged: what a process knows of the law before leaves no trace in the next one
    served.ask("old-move", {"study": STUDY | {"within": 0.12}, "axis": 0})
    moves = [served.ask("old-move", {"study": study, "axis": number}) for number in (0,)]
    for shown, part in zip(moves, better.moves, strict=True):
        assert not isinstance(part.law, str)
        assert part.solution is not None
        stored = json.loads(json.dumps(part.solution.to_dict()))
        assert {**shown["law"], "seconds": 0.0} == {**stored, "seconds": 0.0}
    old = {"study": study, "laws": [[shown["law"] for shown in moves]]}
    answer = served.ask("old", old)
    (gain,) = better.gains(table)
    shares = [100.0 * gain.share(nu) for nu in (1, 2, 3)]
    # of the move, and of the whole cycle, which has no other
    assert [row[-4] for row in answer["tables"][1]["rows"]] == pytest.approx(2 * shares, abs=1e-9)
    off = next(curve for curve in answer["panels"][1]["series"] if curve["name"] == "new law")
    assert max(map(abs, off["values"])) == pytest.approx(gain.deviation, abs=1e-4)
    assert gain.deviation <= 0.1 * (1.0 + 1e-6)
    small = served.ask("old-move", {"study": STUDY | {"within": 1e-4}, "axis": 0})
    assert small["law"] is None
    reason = "keeps its law: none of order 3 and degree 15 so near has less; within 0.0004 mm one has 0.2% less"
    assert written(small["kept"]) == f"{reason} acceleration"
    cycle = better.cycle(speed="200 rpm")
    results = served.ask("export", {"kind": "csv", "view": "old", "request": old, "points": 91})
    assert results["text"] == cycle.export("csv", points=91).text
    kept = served.ask("save", {"kind": "cycle", "view": "old", "request": old})
    assert Cycle.from_json(kept["text"]).peak(2) == cycle.peak(2)
    assert "have no name" in served.ask("save", {"kind": "problem", "view": "old", "request": old})["error"]
    proof = served.ask("save", {"kind": "proof", "view": "old", "request": old})["text"]
    (solution,) = json.loads(proof)["solutions"]
    assert verify(solution).proven
    plain = served.ask("save", {"kind": "problem", "view": "old", "request": {"study": STUDY}})
    assert plain["name"] == "turn.toml"
    assert 'law = "modified sine"' in plain["text"]
    assert "speed of the master" in served.ask(
        "export", {"kind": "csv", "view": "old", "request": {"study": {"text": STUDY["text"]}}}
    )["error"]  # fmt: skip


def test_tables_of_cycles_and_of_controllers_are_opened_as_old_cams(turn: Path) -> None:
    whole = turn.with_name("whole.csv")
    whole.write_text(old_cam_view.example()["text"], "utf-8")
    assert start(str(whole)) == {"view": "old", "old": {"file": "whole.csv", "text": whole.read_text("utf-8")}}
    cycle = read_cycle_table(turn).cycle(speed="200 rpm")
    for name, layout in (("rockwell-cam", "Rockwell"), ("codesys-xyva", "CODESYS"), ("twincat-nc2", "TwinCAT")):
        export = cycle.export(name)
        state = opened_file(OpenRequest(name=f"cam{export.format.extension}", text=export.text))["state"]
        assert state["view"] == "old"
        assert layout in old_cam_view.answer(read(state["old"]))["trust"]["advice"]


def read(entries: dict[str, Any]) -> Any:
    return CycleRequest(study=entries)


@pytest.mark.parametrize(
    ("text", "reason"),
    [("", "table"), ("1;2\n2;3\n", "12"), ("x;y\n" + "\n".join(f"{x};1" for x in range(40)), "never move")],
)
def test_a_text_that_is_no_table_says_why(served: Server, text: str, reason: str) -> None:
    assert reason in served.ask("old", {"study": {"text": text}})["refused"]["reason"]
    assert "refused" in served.ask("old-move", {"study": {"text": text}, "axis": 0})


def test_a_dropped_table_is_shown_and_bettered_within_a_dragged_band(page: Page, served: Server, turn: Path) -> None:
    go(page, served.link(view="old"))
    page.get_by_label("Table of an old cam").wait_for()
    page.get_by_label("Table of an old cam").set_input_files(turn)
    settle(page)
    assert "modified sine" in page.locator("#old-moves").inner_text()
    assert page.locator("#old-curves .dots").count() == 2
    page.get_by_role("button", name="Find better laws").press("Enter")
    assert page.evaluate("() => document.activeElement.id") == "old-gains"
    band = page.get_by_label("Tolerance of the better laws", exact=True)
    band.fill("0.2")
    settle(page)
    study = {"file": "turn.csv", "text": STUDY["text"], "within": 0.2}
    wide = served.ask("old-move", {"study": study, "axis": 0})
    gains = served.ask("old", {"study": study, "laws": [[wide["law"]]]})["tables"][1]["rows"]
    assert f"{gains[1][-2]:.6g}".replace("-", "−") in page.locator("#old-gains").inner_text()
    page.get_by_role("button", name="check this proof").click()
    page.locator("#proof-verdict", has_text="proven old_cam.json").wait_for(timeout=30_000)
    assert "partly checked" not in page.locator("#proof-verdict").inner_text()
    assert "not proven" not in page.locator("#proof-view").inner_text()
    page.get_by_role("button", name="Undo").click()
    page.get_by_role("button", name="Undo").click()
    settle(page)
    assert band.input_value() == "0.07"
    page.get_by_role("textbox", name="speed").fill("300 rpm")
    page.get_by_role("button", name="Export").click()
    settle(page)
    assert "as executed" in page.locator("dialog[open]").inner_text()


def test_the_moves_of_a_table_are_taken_as_the_machine(page: Page, served: Server) -> None:
    go(page, served.link(view="old"))
    page.get_by_role("button", name="Take these moves as the machine").click()
    page.locator("#programme").wait_for()
    settle(page)
    assert [page.get_by_label(f"segment {i} law").input_value() for i in (0, 2)] == ["modified sine", "cycloidal"]


def test_the_frame_of_a_table_is_said_in_fields(page: Page, served: Server) -> None:
    """The example once more in a turn of 720 deg, then its first 41 rows, of a rise, as one lobe of three."""
    go(page, served.link(view="old"))
    fields = {
        name: page.get_by_role("textbox", name=name, exact=True) for name in ("turn", "advance", "rows that count")
    }
    lobes = page.get_by_role("textbox", name="lobes of a turn")
    lobes.fill("2")
    page.locator("#old-trust", has_text="more than a turn of 180: give a longer turn").wait_for(timeout=30_000)
    fields["turn"].fill("720 deg")
    page.locator("#old-trust", has_text="4 moves").wait_for(timeout=30_000)
    fields["turn"].fill("360 deg")
    fields["rows that count"].fill("41")
    fields["advance"].fill("105 mm")
    lobes.fill("3")
    page.locator("#old-trust", has_text="3 moves").wait_for(timeout=30_000)
    settle(page)
    assert page.locator("#old-moves").inner_text().count("modified sine") == 3
    lobes.fill("1")
    fields["turn"].fill("360 deg")
    fields["advance"].fill("")
    fields["rows that count"].fill("")
    page.get_by_role("textbox", name="begin").fill("165 deg")
    page.locator("#old-trust", has_text="the cycle begins at 165 deg of its master").wait_for(timeout=30_000)
    study = old_cam_view.example() | {"turn": "360 deg", "rows": 41, "advance": "105 mm", "lobes": 3}
    rows = served.ask("old", {"study": study})["tables"][0]["rows"]
    assert [row[:3] for row in rows] == [["rise", 120.0 * i, 120.0 * (i + 1)] for i in range(3)]
