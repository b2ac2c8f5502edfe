"""What the page is answered, without a browser: the numbers are the library's, the files make them again."""

import json
import re
import tomllib
from base64 import b64decode
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from html import escape
from math import degrees, hypot
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from optlaws import (
    Axes,
    CamForces,
    Cycle,
    InputError,
    Problem,
    Range,
    Return,
    Rise,
    Solution,
    at_most,
    between,
    synthesize,
)
from tests.documents import ROOT
from tests.explorer.talk import OPTIMAL, Server, written
from tests.internals.cams import cam_files
from tests.internals.cycles import best_of
from tests.internals.explorer import (
    EXAMPLES,
    OPENED,
    CycleRequest,
    FileRequest,
    LawRequest,
    LawsRequest,
    OpenRequest,
    answered,
    axes_view,
    cam_view,
    cycle_view,
    downloads,
    example,
    front_view,
    given_law,
    law_of,
    law_view,
    machine_view,
    opened_file,
    page,
    problem_of,
    solved,
    start,
)
from tests.internals.files import to_toml

STORED = {"law": given_law(LawRequest(name="cubic")).to_dict()}
FORMULA = {"problem": {"order": 3, "B": 1.8, "degree": 7, "minimise": "max(C/4, J/32)", "bounds": {"rms_c": [0, 4.5]}}}
WINDOWS_ASKED = ["b <= 1.2 @ 0.1..0.3", "c + 2*b <= 7 @ 0.6..0.9"]
WINDOWS = {"problem": {"order": 4, "B": 1.7, "windows": WINDOWS_ASKED, "symmetric": False}}
ENDS = {"problem": {"start": [0, 0], "end": [1, 0.5], "degree": 7, "symmetric": False}}


def law(entries: dict[str, Any]) -> LawRequest:
    return LawRequest(**entries)


def cycle_of(**changed: Any) -> CycleRequest:
    study = example()
    study["axis"][0] |= changed
    return CycleRequest(study=study)


def with_law(name: str) -> list[dict[str, str]]:
    return [one | ({"law": name} if "by" in one else {}) for one in example()["axis"][0]["segment"]]


# --- laws and fronts ---


def curve(front: dict[str, Any], name: str) -> list[tuple[float, float]]:
    """The points of a curve of a front."""
    (found,) = (each for each in front["series"] if each["name"] == name)
    return list(zip(found["at"], found["values"], strict=True))


@pytest.mark.sample(2)
@pytest.mark.parametrize("pair", front_view.PAIRS)
def test_points_of_a_front_are_laws_of_their_own_problems(pair: tuple[str, str]) -> None:
    x, y = pair
    swept = front_view.swept_problem(problem_of(law(OPTIMAL)), x, y)
    line = curve(front_view.front(swept, x, y), "front")
    first, second = line[len(line) // 2]
    asked: dict[str, Any] = {x: first if x == "B" else at_most(first)}
    alone = synthesize(replace(swept, **asked))
    assert law_view.digits(getattr(alone.constants, x).value, 6) == law_view.digits(first, 6)
    assert getattr(alone.constants, y).value == pytest.approx(second, rel=1e-4 if y == "J" else 2e-6)


def test_laws_between_the_points_of_a_front_lie_on_its_line() -> None:
    at, values = zip(*curve(front_view.front(Problem(order=4), "B", "C"), "front"), strict=True)
    for B in (1.26, 1.313, 1.338):
        law_between = synthesize(Problem(order=4, B=B))
        assert np.interp(B, at, values) == pytest.approx(law_between.objective, abs=6.5e-3)  # 1e-3 of the picture


def test_a_front_ends_where_laws_end_and_its_limit_lies_below() -> None:
    found = front_view.front(Problem(order=4, J=at_most(70.0)), "B", "C")
    line, limits = curve(found, "front"), dict(curve(found, "best possible"))
    least, greatest = line[0][0], line[-1][0]
    for B, exists in ((least, True), (least - 0.01, False), (greatest, True)):
        assert isinstance(solved(Problem(order=4, J=at_most(70.0), B=B)), Solution) == exists
    assert min(limits) > 1.3  # below it the jerk is too small for any law
    assert all(limits[B] < C for B, C in line)


def test_a_front_of_powers_says_how_far_its_laws_are_from_proven(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(front_view, "_POINTS", 5)
    found = front_view.front(Problem(order=4, minimise="D"), "C", "D")
    assert not found["proven"]
    assert len(curve(found, "front")) == 5
    results = re.fullmatch(r"least D for each bound of C: .* no law is below them by more than (\d+) %", found["words"])
    assert results is not None
    assert 5 < int(results[1]) < 60
    assert front_view.front(Problem(order=4), "B", "C")["proven"]


def test_a_front_without_any_law_says_so() -> None:
    assert front_view.front(Problem(order=4, J=at_most(20.0)), "B", "C")["words"] == "no B has a law of this problem"


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("entries", "entry"),
    [
        ({"B": 1.7, "J": [0, 20]}, "J"),
        ({"B": 1.2, "J": [0, 70]}, "B"),
        ({"B": 1.7, "bounds": {"rms_c": [0, 3.5]}}, "rms_c"),
    ],
)
def test_the_way_back_is_as_short_as_can_be(entries: dict[str, Any], entry: str) -> None:
    question = law({"problem": {"order": 4, "degree": 9} | entries})
    (way,) = (one for one in law_view.nearest(LawsRequest(laws=[question]))["ways"] if one["entry"] == entry)
    problem = problem_of(question)

    def changed(value: float) -> Problem:
        if entry == "rms_c":
            return replace(problem, bounds={"rms_c": at_most(value)})
        asked: dict[str, Any] = {entry: value if entry == "B" else at_most(value)}
        return replace(problem, **asked)

    assert isinstance(solved(changed(way["value"])), Solution)
    assert not isinstance(solved(changed(way["value"] * (1 - 1e-3))), Solution)


def test_a_problem_with_a_law_needs_no_way_back() -> None:
    assert law_view.nearest(LawsRequest(laws=[law(OPTIMAL)])) == {"ways": []}


@pytest.mark.parametrize("entries", [{"order": 13}, {"order": 4, "degree": 42}, {"order": 4, "minimize": "C"}])
def test_what_is_too_large_or_unknown_is_refused_in_its_place(entries: dict[str, Any]) -> None:
    views = law_view.answer(LawsRequest(laws=[law({"problem": entries}), law({"name": "cubic"})]))["laws"]
    assert views[0]["refused"]["word"] == "not understood"
    assert views[1]["constants"][0]["text"] == "1.5"


def test_the_page_reads_no_file(tmp_path: Path) -> None:
    file = tmp_path / "law.json"
    file.write_text(json.dumps(STORED["law"]), "utf-8")
    with pytest.raises(InputError, match="reads none"):
        given_law(LawRequest(name=str(file)))
    with pytest.raises(InputError, match="reads none"):
        cycle_view.read(cycle_of(segment=with_law(str(file))))
    motors = {"motor": "small", "motors": str(file)}
    with pytest.raises(InputError, match="motors: the page reads no catalogue"):
        cycle_view.read(cycle_of(mechanism={"kind": "table", "inertia": "1 kg m^2"}, drive=motors))
    cam = {"kind": "cam", "prime_radius": "60 mm", "segment": with_law(str(file))}
    with pytest.raises(InputError, match="reads none"):
        cycle_view.read(cycle_of(mechanism=cam))
    motors = {"motor": "small"}
    assert "a motor drives a mechanism" in cycle_view.answer(cycle_of(drive=motors))["refused"]["reason"]


def test_a_peak_without_bound_is_said_to_be() -> None:
    view = law_view.answer(LawsRequest(laws=[law({"name": "constant acceleration"})]))["laws"][0]
    assert view["constants"][3] == {"name": "J", "text": "∞", "value": None, "k": "k = 0.5"}


# --- what is shown first ---


def test_a_solution_is_shown_as_its_problem_and_a_law_as_itself(tmp_path: Path) -> None:
    file = tmp_path / "solution.json"
    file.write_text(json.dumps(synthesize(Problem(order=4, B=1.7)).to_dict()), "utf-8")
    assert problem_of(law(start(str(file))["laws"][0])) == Problem(order=4, B=1.7)
    file.write_text(json.dumps(STORED["law"]), "utf-8")
    assert law_of(law(start(str(file))["laws"][0])) == given_law(LawRequest(name="cubic"))


@pytest.mark.parametrize(
    ("file", "view"),
    [
        ("cam_best_laws/cam", "cam"),
        ("cycle_press/cycle", "cycle"),
        ("cycle_belt_lift/cycle", "machine"),
        pytest.param("cycle_rocker/cycle", "machine", marks=pytest.mark.long),
        ("cycle_die_and_table/cycle", "axes"),
        ("cycle_fastest/fastest", "laws"),
        ("fastest_pick/fastest", "laws"),
        ("optimal_table/laws", "laws"),
    ],
)
def test_results_are_opened_as_what_they_are_of(file: str, view: str) -> None:
    found = start(str(ROOT / "results" / f"{file}.json"))
    assert found["view"] == view
    if view == "laws":
        assert all(problem_of(law(entries)) for entries in found["laws"])
        return
    views = {"cam": cam_view, "cycle": cycle_view, "machine": machine_view, "axes": axes_view}
    answer = views[view].answer(CycleRequest(study=part_of(found), axis=found.get("axis", 0)))
    assert "refused" not in answer
    msgspec.json.encode(answer, enc_hook=str)


@pytest.mark.parametrize(("file", "view"), [("cycle_rocker/cycle", "machine"), ("cam_best_laws/cam", "cam")])
def test_opened_results_are_shown_without_a_search(file: str, view: str, monkeypatch: pytest.MonkeyPatch) -> None:
    path = ROOT / "results" / f"{file}.json"
    monkeypatch.setattr(OPENED, "text", path.read_text("utf-8"))
    monkeypatch.setattr("optlaws.jobs.sought_cam.best_cam", None)

    def known(layout: Any, *given: Any) -> Any:
        assert not layout.spans, "a search"
        return best_of(layout, *given)

    monkeypatch.setattr("optlaws.cycles.cycle.best_of", known)
    found = start(str(path))
    asked = CycleRequest(study=part_of(found))
    views = {"cam": cam_view, "machine": machine_view}
    assert "refused" not in views[view].answer(asked)
    if view == "machine":
        (axis,) = json.loads(path.read_text("utf-8"))["axes"].values()
        answer = json.loads(answered("cycle", msgspec.json.encode(asked))[1])
        facts = "; ".join(map(written, answer["trust"]["facts"]))
        assert f"least RMS torque {axis['objective']:.6g}" in facts
        assert f"{axis['lower_bound']:.6g}" in facts


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text.replace('"objective": ', '"objective": 1'),
        lambda _: '{"axes": 3}',
        lambda text: text[: len(text) // 2],
    ],
)
def test_results_that_state_what_is_not_so_are_computed_again(
    damage: Callable[[str], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = ROOT / "results" / "cycle_press" / "cycle.json"
    study = start(str(path))["machine"]
    monkeypatch.setattr(OPENED, "text", damage(path.read_text("utf-8")))
    asked = CycleRequest(study=study | {"title": f"a press {damage(path.read_text('utf-8'))[:40]}"})
    assert OPENED.plan_of(cycle_view.cycle(asked).specification) is None
    assert cycle_view.answer(asked)["trust"]["status"] == "optimal"


def test_the_server_takes_what_the_page_opens(served: Server) -> None:
    path = ROOT / "results" / "cycle_rocker" / "cycle.json"
    machine = served.ask("open", {"name": path.name, "text": path.read_text("utf-8")})["state"]["machine"]
    assert served.ask("machine", {"study": machine})["trust"]["word"] == "local"


def test_a_stored_cycle_plan_and_machine_are_opened(tmp_path: Path) -> None:
    cycle = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm")
    for value in (cycle, cycle.solve(), Axes({"slide": cycle})):
        (tmp_path / "stored.json").write_text(value.to_json(), "utf-8")
        found = start(str(tmp_path / "stored.json"))
        assert [each["kind"] for each in found["machine"]["axis"][0]["segment"]] == ["rise", "return"]


@pytest.mark.parametrize(
    ("given", "message"),
    [("nobody", "nobody"), ("none.toml", "none.toml"), ("{ROOT}/README.md", "README.md")],
)
def test_what_cannot_be_shown_is_refused_by_its_name(given: str, message: str) -> None:
    with pytest.raises((InputError, OSError), match=message):
        start(given.format(ROOT=ROOT))


@pytest.mark.parametrize("file", sorted((ROOT / "problems").glob("*.toml")), ids=lambda file: file.stem)
def test_a_problem_file_with_a_view_is_opened_and_written(file: Path) -> None:
    text = file.read_text("utf-8")
    data = tomllib.loads(text)
    if data["job"] not in {"cam", "cycle", "fastest"}:
        with pytest.raises(InputError, match="`optlaws run` does what this file says"):
            opened_file(OpenRequest(name=file.name, text=text))
        return
    state = opened_file(OpenRequest(name=file.name, text=text))["state"]
    view = state["view"]
    assert part_of(state) == data
    assert tomllib.loads(file_of("problem", view, study=data)["text"]) == data


def test_a_file_that_is_opened_is_refused_in_words() -> None:
    for name, text, message in (
        ("a.toml", "= 3", "a.toml is not TOML"),
        ("a.json", "{", "a.json"),
        ("a.pdf", "", "the page opens"),
        ("../../etc/x.csv", "a;b", "x.csv"),
    ):
        with pytest.raises(InputError, match=message):
            opened_file(OpenRequest(name=name, text=text))


# --- files ---


def file_of(kind: str, view: str = "laws", **request: Any) -> dict[str, str]:
    """A file that the page saves of a view."""
    return downloads.answer(FileRequest(kind=kind, view=view, request=msgspec.Raw(msgspec.json.encode(request))))


def run(code: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {}
    exec(code, names)  # noqa: S102 - what a user would run
    return names


def test_python_makes_the_same_laws_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    laws = [law(OPTIMAL), law(FORMULA), law(STORED), law({"name": "III(7.2)"})]
    code = file_of("python", laws=laws)["text"]
    made = run(code, tmp_path, monkeypatch)["comparison"]
    assert list(made.laws.values()) == [law_of(one) for one in laws]
    assert (tmp_path / "laws.png").stat().st_size > 1000


@pytest.mark.parametrize("entries", [OPTIMAL, FORMULA, ENDS, WINDOWS])
def test_a_problem_is_written_as_python_that_is_the_same_problem(entries: dict[str, Any]) -> None:
    text = file_of("python", laws=[law(entries)])["text"]
    (line,) = (one for one in text.splitlines() if one.startswith("a = synthesize("))
    names: dict[str, Any] = {}
    exec(f"{text.splitlines()[0]}\nproblem = {line[len('a = synthesize(') : -1]}", names)  # noqa: S102 - our own
    assert names["problem"] == problem_of(law(entries))


@pytest.mark.parametrize("entries", [OPTIMAL, FORMULA, ENDS])
def test_a_problem_file_is_the_same_problem(entries: dict[str, Any], tmp_path: Path) -> None:
    file = tmp_path / "problem.toml"
    file.write_text(file_of("problem", laws=[law(entries)])["text"], "utf-8")
    assert problem_of(law(start(str(file))["laws"][0])) == problem_of(law(entries))
    with pytest.raises(InputError, match="belongs to no problem"):
        file_of("problem", laws=[law(STORED)])


def test_a_law_that_is_dragged_is_the_one_that_is_solved_alone() -> None:
    """Convex problems start from the last one, whatever that was: their optimum does not depend on it."""
    expected = [Problem(order=4, B=1.61 + 0.01 * i) for i in range(4)]
    asked = [expected[0], Problem(order=3, B=1.7, minimise="J"), *expected[1:], replace(expected[1], minimise="D")]
    solved.cache_clear()
    for problem in asked:
        found, alone = solved(problem), synthesize(problem)
        assert isinstance(found, Solution)
        assert found.status is alone.status
        assert found.objective == pytest.approx(alone.objective, rel=1e-12)
        assert found.lower_bound == pytest.approx(alone.lower_bound, rel=1e-10)


def test_laws_and_tables_are_those_of_the_command() -> None:
    text = file_of("law", laws=[law(OPTIMAL)])["text"]
    assert json.loads(text)["problem"] == Problem(order=4, B=1.7).to_dict()
    assert json.loads(file_of("law", laws=[law(STORED)])["text"]) == STORED["law"]
    table = file_of("table", laws=[law({"name": "cubic"})])["text"].splitlines()
    assert table[1] == "k,a,b,c,j,d"
    assert len(table) == 203


@pytest.mark.parametrize(
    "data",
    [
        {"a": 1, "b": [1.5, float("inf")], "c": 'é "quoted"\n\x7f', "d": True, "odd key": {"x": []}},
        {"one": {"two": {"three": 3}}, "list": [{"a": {"b": 1}}, {"c": [[1, 2], [3]]}]},
        {},
    ],
)
def test_toml_reads_as_what_was_written(data: dict[str, Any]) -> None:
    assert tomllib.loads(to_toml(data)) == data


def test_toml_has_no_other_values() -> None:
    with pytest.raises(InputError, match="TOML has no Range"):
        to_toml({"a": Range(1.0, 2.0)})
    assert to_toml({"a": None, "b": 1}) == "b = 1\n"
    assert between(1.0, 2.0) == Range(1.0, 2.0)


# --- cams ---


@pytest.mark.parametrize("file", ["cam_press", "cam_rocker", "cam_flat_face"])
def test_a_cam_is_drawn_where_its_follower_touches_it(file: str) -> None:
    study = start(str(ROOT / "problems" / f"{file}.toml"))["cam"]
    view = cam_view.answer(CycleRequest(study=study))
    cam = cam_view.result_of(CycleRequest(study=study)).cam
    roller, turns = view["follower"]["roller"], np.exp(1j * view["turning"] * np.radians(np.arange(361.0)))
    centres = (np.array(view["curves"]["pitch"]) @ np.array([1.0, 1j])) * turns  # as the follower is seen
    for centre, contact in zip(view["curves"]["pitch"], view["curves"]["profile"], strict=True):
        assert hypot(centre[0] - contact[0], centre[1] - contact[1]) == pytest.approx(roller or 0.0, abs=1e-3)
    pivot, arm = view["follower"]["pivot"], study["follower"].get("arm")
    if arm is not None:
        assert np.abs(centres - pivot) == pytest.approx(float(arm.split()[0]), abs=1e-3)
    elif pivot is None and roller is not None:
        offset = float(study["follower"].get("offset", "0 mm").split()[0])
        assert centres.real == pytest.approx(offset, abs=1e-3)
    worst = degrees(cam.extremes.greatest_pressure_angle.value)
    pressures = [panel for panel in view["panels"] if "pressure angle" in str(panel)]
    assert len(pressures) == (worst > 0.0)
    for pressure in pressures:
        assert abs(pressure["peaks"][0]["value"]) == pytest.approx(worst)
        assert max(abs(one) for one in pressure["series"][0]["values"]) <= worst + 1e-6


def test_the_loads_of_a_cam_are_those_of_the_library() -> None:
    study = start(str(ROOT / "problems" / "cam_press.toml"))["cam"]
    results = cam_view.loads(CycleRequest(study=study))
    cam = cam_view.result_of(CycleRequest(study=study)).cam
    forces = CamForces(cam, width="20 mm", friction=study["forces"]["friction"])
    contact, torque, pressure = results["panels"]
    assert [one["name"] for one in results["panels"]] == ["contact force", "torque at the shaft", "Hertz's pressure"]
    assert contact["peaks"][1]["value"] == forces.contact.most
    (turning,) = torque["series"]
    assert turning["values"][turning["at"].index(55.0)] == pytest.approx(
        forces.shaft_torque(np.radians(55.0)), abs=1e-6
    )
    assert max(pressure["series"][0]["values"]) <= 1e-6 * forces.pressure.high
    assert f"RMS torque {forces.rms_torque[1]:.5g} N m" in results["facts"]
    (spring,) = (fact for fact in results["facts"] if fact.startswith("least spring without lift-off: stiffness "))
    assert "preload 0.4 N" in spring
    light = study | {"motion": study["motion"] | {"drive": {"mass": "20 kg"}}}
    assert "the follower lifts off at" not in cam_view.loads(CycleRequest(study=light))["facts"][0]
    loose = {name: value for name, value in light.items() if name != "spring"}
    assert "the follower lifts off at" in cam_view.loads(CycleRequest(study=loose))["facts"][0]
    jammed = light | {"forces": {"friction": {"contact": 0, "guide": 0.9, "overhang": "90 mm", "length": "20 mm"}}}
    (why,) = cam_view.loads(CycleRequest(study=jammed))["facts"]
    assert "the follower jams in its guide" in why


def test_a_cam_beyond_its_limits_is_not_called_free_of_undercut() -> None:
    trust = cam_view.answer(CycleRequest(study=cam_view.example() | {"prime_radius": "45 mm"}))["trust"]
    assert (trust["status"], trust["word"]) == ("refused", "beyond a limit")
    assert "deg of 30 deg" in trust["advice"]


def test_a_cam_that_is_undercut_says_so_and_one_that_is_none_why() -> None:
    study = cam_view.example()
    facts = cam_view.sizes(CycleRequest(study=study))["facts"]
    sizes = "least prime circle, by the pressure angle ", "greatest roller "
    least, _ = (next(float(fact[len(size) :].split()[0]) for fact in facts if fact.startswith(size)) for size in sizes)
    for radius, beyond in ((least, False), (least * 0.999, True)):
        view = cam_view.answer(CycleRequest(study=study | {"prime_radius": f"{radius + 1e-5} mm"}))
        assert view["panels"][1]["beyond"] == beyond
    large = study["follower"] | {"radius": "59 mm"}
    small = cam_view.answer(CycleRequest(study=study | {"follower": large}))
    assert small["trust"]["word"] == "undercut"
    assert "prime circle larger" in small["trust"]["advice"]
    assert not small["panels"][1]["beyond"]
    assert cam_view.answer(CycleRequest(study=study | {"prime_radius": "50 mm"}))["panels"][1]["beyond"]
    for changed in ({"prime_radius": "18 kg"}, {"follower": {"kind": "translating roller"}}, {"base": "18 mm"}):
        assert cam_view.answer(CycleRequest(study=study | changed))["refused"]["word"] == "no such cam"


def test_a_cam_stands_beside_the_one_with_the_usual_law_in_a_table() -> None:
    """The peaks of the page are those of the two cycles; no sentence repeats a row."""
    best = cam_view.example()
    usual = deepcopy(best)
    for segment in usual["motion"]["segment"]:
        if segment["kind"] != "dwell":
            segment["law"] = "modified sine"
    answer, alone = (cam_view.sizes(CycleRequest(study=study)) for study in (best, usual))
    headings, rows = (answer["beside"][name] for name in ("headings", "rows"))
    assert headings == ["what", "modified sine", "this law", "difference"]
    known = {what: [each.value for each in values] for what, *values, _ in rows}
    peaks = [cam_view.result_of(CycleRequest(study=study)).plan.peak(2) for study in (usual, best)]
    assert known["peak acceleration"] == pytest.approx(peaks, rel=1e-9)
    assert known["prime circle"] == [60.0, 60.0]
    assert not any("modified sine has" in str(fact) for fact in answer["facts"])
    assert alone["beside"]["headings"] == ["what", "value"]
    of_usual = {what: value.value for what, value in alone["beside"]["rows"]}
    for what in ("peak acceleration", "peak jerk"):
        assert known[what][0] == pytest.approx(of_usual[what], rel=1e-9)


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", sorted(cam_files.FORMATS))
def test_a_cam_is_saved_in_every_format(name: str) -> None:
    made = file_of(name, "cam", study=cam_view.example())
    assert len(made["text"]) > 1000
    assert made["name"].startswith("cam.")
    assert tomllib.loads(file_of("problem", "cam", study=cam_view.example())["text"]) == cam_view.example()


# --- cycles ---


def test_a_cycle_within_its_limits_is_proven() -> None:
    view = cycle_view.answer(cycle_of())
    assert view["trust"]["word"] == "proven optimal"
    assert view["table"]["headings"][5] == "peak velocity, mm/s"
    assert [row[5] for row in view["table"]["rows"]] == pytest.approx([616.0, 0.0, 616.0, 0.0, 616.0])
    assert not any(peak["beyond"] for one in view["segments"] for peak in one["peaks"])
    assert [one["value"] for one in view["panels"][1]["limits"]] == [616.0] * 2  # a dwell has none


def test_a_given_law_beyond_a_limit_is_marked() -> None:
    view = cycle_view.answer(cycle_of(segment=with_law("cycloidal")))
    assert (view["trust"]["status"], view["trust"]["word"]) == ("refused", "beyond a limit")
    assert view["trust"]["advice"] == "Limits exceeded: segment 3 (Return): velocity, 840 mm/s of 616 mm/s."
    assert cycle_view.answer(cycle_of(segment=with_law("cycloidal"), limits={}))["trust"] is None
    assert [one["peaks"][0]["beyond"] for one in view["segments"]] == [True, False, True, False]


def test_a_cycle_that_cannot_keep_its_limit_says_how_far_to_go_back() -> None:
    asked = cycle_of(limits={"velocity": "430 mm/s"})
    assert "Return" in cycle_view.answer(asked)["refused"]["reason"]
    (way,) = cycle_view.nearest(asked)["ways"]
    assert "refused" not in cycle_view.answer(cycle_of(limits={"velocity": way["value"]}))
    tighter = f"{float(way['value'].split()[0]) * 0.999} mm/s"
    assert "refused" in cycle_view.answer(cycle_of(limits={"velocity": tighter}))


@pytest.mark.parametrize(
    "file", ["cycle_press", "cycle_flying_shear", "cycle_savin_design", "cycle_elastic_load", "cycle_geared_table"]
)
def test_python_and_files_make_the_same_cycle(file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = start(str(ROOT / "problems" / f"{file}.toml"))
    view, study = found["view"], found["machine"]
    made = run(file_of("python", view, study=study)["text"], tmp_path, monkeypatch)["cycle"]
    known = cycle_view.cycle(CycleRequest(study=study))
    assert made.peak(2) == known.peak(2)
    assert (made.drive, made.load) == (known.drive, known.load)
    assert view == "machine" or len(file_of("table", view, study=study)["text"].splitlines()) == 363


@pytest.mark.parametrize("view", downloads.VIEWS)
def test_the_page_offers_files_that_there_are_of_its_view(view: str) -> None:
    listed = re.search(r"files = \[([^\]]*)\]", page()[f"views/{view}.js"].decode())
    offered = set(re.findall(r'"(\w+)"', listed[1] if listed else ""))
    assert offered <= set(downloads.VIEWS[view][0])
    assert offered & {"problem", "table"}


def part_of(state: dict[str, Any]) -> dict[str, Any]:
    """The machine of a state, the moves, or the part that has the name of its view."""
    found: dict[str, Any] = state[state["view"] if state["view"] in state else "machine"]
    return found


def example_of(view: str) -> dict[str, Any]:
    """What a view shows at first."""
    return EXAMPLES.get({"fastest": "moves"}.get(view, view), cycle_view.example)()


@pytest.mark.sample(4)
@pytest.mark.parametrize("view", downloads.VIEWS)
def test_the_report_of_a_view_is_printed_with_its_facts_and_curves(view: str) -> None:
    study = example_of(view)
    asked: dict[str, Any] = {"laws": [OPTIMAL]} if view == "laws" else {"study": study}
    file = file_of("report", view, **asked, **({"points": 2} if view == "advice" else {}))
    of = study.get("title", "A motion") if view != "laws" else "least C, B = 1.7, order 4, degree 9"
    assert (file["name"], file["type"]) == (f"{'_'.join(re.findall('[A-Za-z0-9.]+', of))}.html", "text/html")
    request = msgspec.json.decode(msgspec.json.encode(asked), type=LawsRequest if view == "laws" else CycleRequest)
    report = (axes_view.axes_of(study) if view == "axes" else downloads.VIEWS[view][1](request)).report()
    pictures = [
        b64decode(text).decode() for text in re.findall(r"src=\"data:image/svg\+xml;base64,([^\"]+)\"", file["text"])
    ]
    assert len(pictures) == len({panel.across for panel in report.panels})
    alternatives = ", ".join(re.findall(r'<img alt="([^"]*)"', file["text"]))
    assert alternatives == ", ".join(escape(panel.title) for panel in report.panels)
    assert sum(picture.count('<g id="axes_') for picture in pictures) == len(report.panels)
    assert file["text"].count("<table") == 1 + len(report.tables)
    assert all(escape(row.name) in file["text"] for row in report.facts)
    assert not re.search('<script|href=|src="(?!data:)', file["text"])


@pytest.mark.parametrize("view", ["cycle", "axes", "machine", "cam", "fastest", "old"])
def test_every_kind_of_file_is_made_of_the_first_study_of_its_view(view: str) -> None:
    for kind in downloads.VIEWS[view][0]:
        file = file_of(kind, view, study=example_of(view))
        assert file["text"]
        assert Path(file["name"]).suffix


@pytest.mark.parametrize(("kind", "view", "named"), [("tabel", "cycle", "table"), ("table", "cycel", "cycle")])
def test_a_file_that_there_is_not_is_refused_with_the_nearest(kind: str, view: str, named: str) -> None:
    with pytest.raises(InputError, match=f"did you mean '{named}'"):
        file_of(kind, view, study=example())


def test_files_of_a_cycle_have_no_folder_in_their_names() -> None:
    named = example()
    named["axis"][0]["name"] = "../../x\ny"
    table = file_of("table", "cycle", study=named)
    assert table["name"] == "x_y.csv"
    assert "\ny" not in table["text"]


def test_a_bound_of_minus_infinity_is_no_bound() -> None:
    view = law_view.answer(LawsRequest(laws=[law({"problem": {"order": 4, "B": 1.7, "minimise": "integral(b*c)"}})]))
    facts = " ".join(view["laws"][0].get("trust", {}).get("facts", []))
    assert "below ∞" not in facts
    assert "below −∞" not in facts


def test_how_far_a_law_is_above_the_limit_is_told() -> None:
    view = law_view.answer(LawsRequest(laws=[law(OPTIMAL)]))["laws"][0]
    solution = synthesize(Problem(order=4, B=1.7))
    assert solution.best_possible is not None
    results = view["trust"]["facts"][-1]
    assert float(results.split(" % above")[0].rpartition(" ")[2]) == pytest.approx(
        100.0 * (solution.objective / solution.best_possible - 1.0), abs=0.05
    )
