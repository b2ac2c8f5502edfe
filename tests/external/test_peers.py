"""Other packages side by side with this one, on cams and tables drawn at random."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from optlaws import Cycle, DiscCam, TranslatingFlat, TranslatingRoller, catalogue, least_prime_circle
from tests.exports.moves import exported
from tests.exports.samples import SAID, optimal
from tests.exports.structured_text import without_comments
from tests.external.test_disc_cams import inch_moves

pytestmark = pytest.mark.long
#: the moves of these cams as the package mechanism takes them
MECHANISM: dict[str, list[tuple[Any, ...]]] = {
    "one rise": [("Rise", 1, 90), ("Dwell", 90), ("Fall", 1, 90), ("Dwell", 90)],
    "two rises": [
        *(("Rise", 3, 90), ("Dwell", 15), ("Fall", 3, 90), ("Dwell", 15)),
        *(("Rise", 2, 60), ("Dwell", 15), ("Fall", 2, 60), ("Dwell", 15)),
    ],
}
KINDS = {"cycloidal": "cycloidal", "harmonic": "simple harmonic"}


def mechanism_cam(name: str) -> Any:
    package = pytest.importorskip("mechanism")
    return package.Cam(motion=MECHANISM[name], degrees=True, omega=2.0 * np.pi, h=2e-4)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", MECHANISM)
def test_prime_circles_beside_mechanism(name: str, kind: str) -> None:
    """On 31,000 places theirs is a little below ours, for random rollers and limits."""
    theirs, cycle = mechanism_cam(name), Cycle(inch_moves(name, KINDS[kind]), speed="60 rpm")
    rng = np.random.default_rng(3)
    for roller, limit in zip(rng.uniform(0.2, 0.6, 4).tolist(), rng.uniform(15.0, 35.0, 4).tolist(), strict=True):
        answer = theirs.get_base_circle(kind=kind, follower="roller", roller_radius=roller, max_pressure_angle=limit)
        follower = TranslatingRoller(f"{roller!r} inch")
        ours = least_prime_circle(cycle, follower, pressure_angle=f"{limit!r} deg").radius / 0.0254
        assert -1e-12 <= ours - (answer["Rb"] + roller) < 1e-6 * ours
    answer = theirs.get_base_circle(kind=kind, follower="flat", desired_min_rho=0.4)
    ours = least_prime_circle(cycle, TranslatingFlat(), radius_of_curvature="0.4 inch").radius / 0.0254
    assert -1e-12 <= ours - answer["Rb"] < 1e-5


def test_prime_circles_of_mechanism_with_an_offset_break_their_limit() -> None:
    """It adds the offset's square to that of the prime circle, where the height over the axis has the difference."""
    theirs, cycle = mechanism_cam("two rises"), Cycle(inch_moves("two rises", "cycloidal"), speed="60 rpm")
    beyond = []
    for offset in (0.25, 0.5, 1.0):
        limits = {"roller_radius": 1.0, "max_pressure_angle": 30.0, "eccentricity": offset}
        radius = float(theirs.get_base_circle(kind="cycloidal", follower="roller", **limits)["Rb"]) + 1.0
        follower = TranslatingRoller("1 inch", f"{offset} inch")
        cam = DiscCam(cycle, prime_radius=f"{radius!r} inch", follower=follower)
        beyond.append(float(np.degrees(cam.extremes.greatest_pressure_angle.value)) - 30.0)
        # what it would be with the difference: the same root as ours
        ours = least_prime_circle(cycle, follower, pressure_angle="30 deg").radius / 0.0254
        assert radius**2 + offset**2 == pytest.approx(ours**2 - offset**2, rel=1e-6)
    assert beyond == pytest.approx([0.036, 0.129, 0.413], abs=2e-3)


@pytest.mark.parametrize(
    ("theirs", "ours"),
    [("cycloidal", "cycloidal"), ("modified_sine", "modified sine"), ("poly345", "3-4-5 polynomial")],
)
def test_laws_of_pyplcopen(theirs: str, ours: str) -> None:
    pyplcopen = pytest.importorskip("pyplcopen")
    x, y = np.array(pyplcopen.generate_cam_law(theirs, 1.0, 1.0, 64)).T
    assert catalogue[ours].law(x) == pytest.approx(y, abs=4e-15)


def with_named_types(source: str) -> str:
    """A function block as pyplcopen's compiler takes it: no constants, and types of arrays declared before."""
    types: list[str] = []

    def named(match: re.Match[str]) -> str:
        types.append(f"TYPE Table{len(types)} : {match[2]}; END_TYPE")
        return f"{match[1]} : Table{len(types) - 1}"

    plain = without_comments(source).replace("VAR CONSTANT", "VAR")
    body = re.sub(r"(\w+) : (ARRAY\[[^\]]*\] OF \w+)", named, plain)
    return "\n".join([*types, body])


@pytest.mark.parametrize("block", ["law", "law in REAL", "front"])
def test_the_compiler_of_pyplcopen_takes_the_function_blocks(block: str) -> None:
    pyplcopen = pytest.importorskip("pyplcopen")
    sources: dict[str, Callable[[], str]] = {
        "law": lambda: optimal().export("iec-st", name="FB_Cam", **SAID).text,
        "law in REAL": lambda: optimal().export("iec-st-real", name="FB_Cam", **SAID).text,
        "front": lambda: exported("pieces", "iec-st").text.replace("FB_pieces", "FB_Cam"),
    }
    source = sources[block]()
    inputs = dict(re.findall(r"    (\w+) : (BOOL|L?REAL);", source.split("END_VAR")[0]))
    call = ", ".join(f"{name} := {'TRUE' if kind == 'BOOL' else '1.0'}" for name, kind in inputs.items())
    document_of: Any = pyplcopen._StLanguageDocument
    program = f"\nPROGRAM Main\nVAR\n    cam : FB_Cam;\nEND_VAR\ncam({call});\nEND_PROGRAM\n"
    document = document_of(with_named_types(source) + program)
    assert [(one["range"]["start"]["line"], one["message"]) for one in document.diagnostics()] == []
    broken = document_of((with_named_types(source) + program).replace("jerk : ", "jolt : ", 1))
    assert broken.diagnostics()
