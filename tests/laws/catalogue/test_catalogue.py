"""The catalogue: constants of the reference table, names, search, and what is published otherwise."""

import re
import subprocess
import sys
from math import inf
from typing import Any

import numpy as np
import pytest

from optlaws import InputError, catalogue, smoothstep
from tests.internals.laws import canonical, continuity_with_rest, plain
from tests.tables import rows

NAMES = {  # keys of the reference table that are no name of the catalogue
    "lazy_modified_trapezoid": "lazy modified trapezoid",
    "parabolic": "constant acceleration",
}
ROWS = rows("law_catalogue")
CONTINUITY = {"b": 1, "c": 2, "j": 3, "j'": 4}
HALVES = {name for name in catalogue if name.startswith("half ")}
every_entry = pytest.mark.parametrize("name", list(catalogue))


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["key"])
def test_constants_are_the_reference_s(row: dict[str, str]) -> None:
    entry = catalogue[NAMES.get(row["key"], row["key"])]
    constants = entry.constants
    for name in "BCD":
        assert getattr(constants, name).value == pytest.approx(float(row[name]), rel=1e-9)
    if row["k_of_D"]:
        assert constants.D.k == pytest.approx(float(row["k_of_D"]), abs=1e-9)
    J = row["J"].split()[0]
    if J == "inf":  # where c jumps, which for the law alone it does inside only
        assert constants.J.value == inf or abs(entry.law.c(0.0)) > 0.1
    else:
        assert constants.J.value == pytest.approx(float(J), rel=1e-9)
    # the triple harmonic's jerk is continuous too, as its row says in words
    expected = 4 if row["key"] == "triple_harmonic_zjx" else CONTINUITY[row["continuity"].partition(",")[0]]
    assert entry.continuity == expected


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["key"])
def test_what_is_from_memory_there_is_so_here_unless_its_source_was_seen(row: dict[str, str]) -> None:
    entry = catalogue[NAMES.get(row["key"], row["key"])]
    if entry.from_memory:
        assert "from memory" in row["continuity"] + row["published"]
    if "from memory" in row["published"] and not entry.from_memory:
        assert "eq. " in entry.source


@every_entry
def test_entries_rise_from_0_to_1(name: str) -> None:
    law = catalogue[name].law
    assert law.a([0.0, 1.0]) == pytest.approx([0.0, 1.0], abs=1e-13)
    assert law.extrema(1)[0].value >= -1e-12
    if name != "constant velocity":
        moving = law.constants.B.value if name in HALVES else 0.0
        assert sorted(law.b([0.0, 1.0])) == pytest.approx([0.0, moving], abs=1e-13)
    k = np.linspace(0.0, 1.0, 101)
    symmetric = float(np.abs(law.a(k) + law.a(1.0 - k) - 1.0).max())
    assert (symmetric > 0.01) == (name == "double harmonic" or name in HALVES)


def test_half_segments_are_those_of_kloomok_and_muffley() -> None:
    k, pi = np.linspace(0.0, 1.0, 41), np.pi
    forms = {  # displacement of a stroke of 1, and its three derivatives
        "C1": (k - np.sin(pi * k) / pi, 1 - np.cos(pi * k), pi * np.sin(pi * k), pi**2 * np.cos(pi * k)),
        "C2": (k + np.sin(pi * k) / pi, 1 + np.cos(pi * k), -pi * np.sin(pi * k), -(pi**2) * np.cos(pi * k)),
        "H1": tuple(np.array([1, 0, 0, 0])[:, None] - (pi / 2) ** np.arange(4)[:, None] * [
            np.cos(pi * k / 2), -np.sin(pi * k / 2), -np.cos(pi * k / 2), np.sin(pi * k / 2)]),
        "H2": tuple((pi / 2) ** np.arange(4)[:, None] * [
            np.sin(pi * k / 2), np.cos(pi * k / 2), -np.sin(pi * k / 2), -np.cos(pi * k / 2)]),
    }  # fmt: skip
    for code, values in forms.items():
        for nu, expected in enumerate(values):
            assert catalogue[code].law(k, nu) == pytest.approx(expected, abs=1e-14 * 10**nu)
    for halves, whole in ((("C1", "C2"), "C5"), (("H1", "H2"), "H5")):  # two halves are the full segment
        for place, half in enumerate(halves):
            for nu in range(4):
                whole_there = catalogue[whole].law((k + place) / 2, nu) - (place / 2 if nu == 0 else 0.0)
                assert catalogue[half].law(k, nu) == pytest.approx(whole_there * 2.0 ** (1 - nu), abs=1e-12)
    for cycloid, (B, C, J) in {"C3": (2.0, pi, pi**2), "H4": (pi / 2, pi**2 / 4, pi**3 / 8)}.items():
        constants = catalogue[cycloid].constants
        assert (constants.B.value, constants.C.value, constants.J.value) == pytest.approx((B, C, J), rel=1e-15)


@every_entry
def test_continuity_is_where_derivatives_stop_meeting(name: str) -> None:
    entry, law = catalogue[name], catalogue[name].law
    nu = entry.continuity
    if nu < 4:
        ends = np.abs(law([0.0, 1.0], nu + 1)).max()
        inside = law.jumps(nu + 1) if hasattr(law, "jumps") else ()
        assert ends > 1e-6 or inside
    for order in range(1, nu + 1):
        assert np.abs(law([0.0, 1.0], order)).max() <= 1e-9 * max(law.peak(order).value, 1.0)


def test_names_are_of_one_law_each() -> None:
    seen: dict[str, str] = {}
    for entry in catalogue.values():
        for name in {canonical(one) or plain(one) for one in (entry.name, *entry.aliases)}:
            assert seen.setdefault(name, entry.name) == entry.name


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("BESTEHORN", "cycloidal"),
        ("Bestehorn-Sinoide", "cycloidal"),
        ("POLYNOM5", "3-4-5 polynomial"),
        ("Poly7", "4-5-6-7 polynomial"),
        ("MODIFIED_SINE", "modified sine"),
        ("ModifiedSinusoid", "modified sine"),
        ("Quadratische Parabel", "constant acceleration"),
        ("Modifiziertes Beschleunigungstrapez", "modified trapezoid"),
        ("K", "simple harmonic"),
        ("Co", "cycloidal"),
        ("Shun", "3-4-5 polynomial"),
        ("0317(1.5)", "0317(1,5)"),
        ("0050", "constant acceleration"),
    ],
)
def test_aliases_lead_to_the_law(name: str, found: str) -> None:
    assert name in catalogue
    assert catalogue[name] is catalogue[found]
    assert catalogue.search(name)[0].name == found or canonical(name)


def test_any_code_is_a_law() -> None:
    entry = catalogue["1005(2)"]
    assert entry.name == "1005(2)"
    assert entry.law.peak(2).k == 0.1
    assert "1005(2)" not in list(catalogue)


@pytest.mark.parametrize(
    ("text", "first"),
    [
        ("sinuslinie", ["simple harmonic", "cycloidal", "modified sine"]),
        ("modifed sine", ["modified sine"]),
        ("poly", ["cubic", "3-4-5 polynomial", "4-5-6-7 polynomial", "5-6-7-8-9 polynomial"]),
        ("handbook 4.12", ["Freudenstein 1-3"]),
        ("qwerty", []),
        ("", []),
    ],
)
def test_search_ranks(text: str, first: list[str]) -> None:
    found = [entry.name for entry in catalogue.search(text)]
    assert found[: len(first)] == first
    if not first:
        assert found == []


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("modifed sine", "no law is called 'modifed sine'; did you mean 'modified sine'"),
        ("qwerty", "`optlaws catalogue` lists them"),
        ("0399", "50 hundredths"),
        (3, "the name of a law is text, got 3"),
    ],
)
def test_unknown_names_are_refused_like_keys(name: Any, message: str) -> None:
    for error in (InputError, KeyError):
        with pytest.raises(error) as raised:
            catalogue[name]
        assert message in str(raised.value)
    assert name not in catalogue
    assert catalogue.get(name) is None


def test_it_is_a_mapping_of_its_names() -> None:
    assert len(catalogue) == len(list(catalogue)) >= 33
    assert [entry.name for entry in catalogue.values()] == list(catalogue)
    assert re.fullmatch(r"<catalogue of \d+ laws: .*>", repr(catalogue))


def test_disagreements_with_what_is_published() -> None:
    found = {
        entry.name: text
        for entry in catalogue.values()
        for one in entry.published
        for text in one.disagreements(entry.constants)
    }
    assert found == {"lazy modified trapezoid": "C = 4.88 is 5.27881", "modified sine CV 33%": "C = 6.616 is 6.616604"}


def test_it_is_read_when_it_is_used() -> None:
    code = "import sys, optlaws; print('_entries' in vars(optlaws.catalogue), 'tomllib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]


def test_entries_are_plain_data() -> None:
    data = catalogue["modified sine"].to_dict()
    assert data["aliases"]["TwinCAT"] == ["MODSINUSLINIE = 11"]
    assert data["published"][0]["C"] == "5.53"
    assert data["law"]["kind"] == "piecewise"


@pytest.mark.parametrize("order", [2, 9, 10, 11])
def test_continuity_with_rest_goes_to_the_ninth_derivative(order: int) -> None:
    assert continuity_with_rest(smoothstep(order)) == min(order - 1, 9)
