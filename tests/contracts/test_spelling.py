"""Names are taken in American spelling too, by Python, files and commands; none of them is shown."""

from typing import Any, cast

import pytest

import optlaws
from optlaws import Body, CallError, Cycle, Problem, Rise, advise, fastest, time_front
from tests.internals.cli import exit_code

MOVE: dict[str, Any] = {"period": "0.3 s", "advance": "35 mm"}


def test_names_of_python() -> None:
    from optlaws import synthesise  # type: ignore[attr-defined] # the stubs have one spelling

    assert synthesise is optlaws.synthesize
    assert optlaws.catalog is optlaws.catalogue  # type: ignore[attr-defined] # likewise
    assert not {"synthesise", "catalog"} & {*dir(optlaws)}
    with pytest.raises(AttributeError, match="no attribute 'catalogs'"):
        _ = optlaws.catalogs  # type: ignore[attr-defined] # there is none


def test_entries_and_keywords() -> None:
    american: dict[str, Any] = {"minimize": "jerk"}
    body, front, problem = (cast("Any", known) for known in (Body, time_front, Problem))
    cycle = Cycle([Rise("35 mm")], **MOVE, **american)
    assert cycle == Cycle([Rise("35 mm")], **MOVE, minimise="jerk")
    assert cycle.minimize == "jerk"  # type: ignore[attr-defined] # the types have one spelling
    assert body(2.0, center=(0.1, 0.0)).centre == (0.1, 0.0)
    move = Rise("35 mm", "0.1 s")
    assert advise(move, laws=["cycloidal"], **american).minimise == "jerk"
    quick = fastest(Problem(order=3), stroke="35 mm", limits={"jerk": "900 m/s^3"})
    assert front(quick, points=3, minimize="rms acceleration").minimise == "rms acceleration"
    with pytest.raises(CallError, match="'minimize'; did you mean 'minimise'"):
        problem(order=3, minimise="C", minimize="J")
    with pytest.raises(AttributeError, match="no attribute 'maximize'"):
        _ = cycle.maximize  # type: ignore[attr-defined] # there is none


def test_entries_of_files() -> None:
    cycle = Cycle([Rise("35 mm")], **MOVE, minimise="jerk")
    assert Cycle.from_json(cycle.to_json().replace("minimise", "minimize")) == cycle
    both = {**cycle.to_dict(), "minimize": "velocity"}
    with pytest.raises(optlaws.InputError, match="unknown entry of a stored cycle 'minimize'"):
        Cycle.from_dict(both)


@pytest.mark.parametrize("option", [["--minimize", "J"], ["--minimize=J"]])
def test_options_of_commands(option: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(["solve", *option, "--order", "3", "--degree", "5", "--peak-velocity", "1.8"]) == 0
    assert "J " in capsys.readouterr().out
    assert exit_code(["solve", "--help"]) == 0
    assert "minimize" not in capsys.readouterr().out
