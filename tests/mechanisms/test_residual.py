"""Residual vibration that is small over frequencies or weighed by a measured spectrum: greatest values and proofs."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BSplines,
    Certificate,
    Chebyshev,
    Follower,
    InfeasibleProblem,
    InputError,
    MotionLaw,
    Pieces,
    Problem,
    at_most,
    catalogue,
    polydyne,
    read_spectrum,
    residual_phasor,
    residual_vibration,
    savin,
    smoothstep,
    synthesize,
)
from optlaws.verification import verify
from tests.internals.mechanisms import above
from tests.mechanisms.cam_programs import integrated, residuals
from tests.sampling import examples

NU = np.linspace(18.0, 22.0, 2001)
LAWS = [savin("III", 7.2), savin("IV", 11.0), catalogue["modified sine"].law, catalogue["cycloidal"].law]


@given(st.sampled_from(LAWS), st.floats(2.0, 60.0), st.floats(0.0, 40.0), st.floats(0.0, 0.9))
@examples(50)
def test_the_greatest_residuals_of_any_interval_are_those_of_responses(
    law: MotionLaw, low: float, length: float, damping: float
) -> None:
    nu = np.linspace(low, low + length, 1001)
    accelerations = residuals(law.b, nu, damping)
    for of, grid in (("acceleration", accelerations), ("displacement", accelerations / nu**2)):
        peak = residual_vibration(frequency=(low, low + length), damping=damping, of=of).peak(law)  # type: ignore[arg-type]
        assert low <= peak.k <= low + length
        assert grid.max() <= peak.value * (1 + 1e-9) + 1e-12
        own = getattr(Follower(peak.k, damping).response(law), f"residual_{of}")
        assert peak.value == pytest.approx(own, rel=1e-9, abs=1e-12)


CASES = [
    Problem(order=3, basis=Chebyshev(11), bounds={residual_vibration(frequency=(18, 22)): at_most(0.1)}),
    Problem(order=3, basis=Chebyshev(11), bounds={residual_vibration(frequency=(18, 22)): at_most(0.01)}, B=2.1),
    Problem(
        order=3,
        basis=Chebyshev(11),
        bounds={residual_vibration(frequency=(18, 22), damping=0.05): at_most(0.01)},
        symmetric=False,
    ),
    Problem(order=3, basis=BSplines(8, 4), bounds={residual_vibration(frequency=(18, 22)): at_most(0.05)}),
    Problem(
        order=3,
        basis=Pieces(12, degree=5, continuity=3),
        bounds={residual_vibration(frequency=(18, 22), damping=0.02): at_most(0.1)},
    ),
    Problem(order=3, basis=Chebyshev(11), minimise="J", bounds={residual_vibration(frequency=(18, 22)): at_most(0.1)}),
]


@pytest.mark.sample(2)
@pytest.mark.parametrize("problem", CASES, ids=range(len(CASES)))
def test_the_residual_of_a_robust_law_is_below_the_bound_everywhere(problem: Problem) -> None:
    ((constant, asked),) = problem.bounds.items()
    damping = float(getattr(constant, "damping", np.nan))
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    assert residuals(solution.law.b, NU, damping).max() <= asked.high * (1 + 1e-8)
    for nu in (18.0, 19.3, 22.0):
        assert integrated(solution.law.a, nu, damping).residual <= asked.high * (1 + 1e-6)


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_a_robust_polydyne_law_has_no_residual_at_its_design_and_little_around_it(damping: float) -> None:
    bound = residual_vibration(frequency=(18, 22), damping=damping, design=20)
    asked = Problem(
        order=4,
        basis=Chebyshev(11),
        minimise=f"C_cam(frequency=20, damping={damping})",
        bounds={bound: at_most(0.1)},
        symmetric=damping == 0.0,
    )
    solution = synthesize(asked)
    cam = polydyne(solution.law, 20, damping)
    assert solution.status.value == "optimal"
    grid = residuals(cam.b, NU, damping)
    assert grid.max() <= 0.1 * (1 + 1e-8)
    assert grid[1000] < 1e-8
    # Savin's family III has ten times the residual, and its cam accelerates more
    known = polydyne(savin("III", 7.2), 20, damping)
    assert residuals(known.b, NU, damping).max() > 10 * grid.max()
    assert solution.objective < known.constants.C.value


def test_the_least_residual_that_an_acceleration_allows() -> None:
    wide = residual_vibration(frequency=(18, 22), damping=0.05)
    asked = Problem(order=3, C=at_most(6.0), minimise=wide, symmetric=False)
    solution = synthesize(asked)
    assert solution.status.value == "optimal"
    assert solution.constants.C.value == pytest.approx(6.0, rel=1e-8)
    assert residuals(solution.law.b, NU, 0.05).max() == pytest.approx(solution.objective, rel=1e-6)
    # the other way round the same law is found
    back = synthesize(Problem(order=3, bounds={wide: at_most(solution.objective)}, symmetric=False))
    assert back.objective == pytest.approx(6.0, rel=1e-6)


def test_a_residual_out_of_reach_is_refused_with_proof() -> None:
    for asked in (
        Problem(
            order=3, B=1.859375, basis=Chebyshev(9), bounds={residual_vibration(frequency=(18, 22)): at_most(1e-3)}
        ),
        Problem(
            order=3, C=at_most(6), basis=Chebyshev(9), bounds={residual_vibration(frequency=(18, 22)): at_most(1e-2)}
        ),
    ):
        with pytest.raises(InfeasibleProblem, match=r"residual\(frequency=\(18.0, 22.0\)\)") as caught:
            synthesize(asked)
        proof = caught.value.proof
        assert isinstance(proof, Certificate)
        assert proof.proves_infeasible or proof.bound > asked.bounds["residual(frequency=(18.0, 22.0))"].high
        assert "frequency = 18" in str(caught.value) or "below" in str(caught.value)


def test_a_spoilt_certificate_proves_less() -> None:
    proof = synthesize(CASES[0]).certificate
    data = proof.to_dict()
    for contact in data["contacts"]:
        if contact["direction"]:
            contact["direction"] = [-one for one in contact["direction"]]
    assert not Certificate.from_dict(data).bound > proof.bound * 0.9


# --- measured spectra ---


SPECTRUM = ((16.0, 0.2), (18.0, 1.0), (19.0, 0.4), (22.0, 0.9), (24.0, 0.0), (26.0, 0.0), (27.0, 0.3))


def weighed(law: object, nu: np.ndarray, damping: float) -> np.ndarray:
    weights = np.interp(nu, *np.array(SPECTRUM).T)
    return np.asarray(weights * nu**2 * np.abs(residual_phasor(law, nu, damping)))  # type: ignore[arg-type]


@pytest.mark.long
def test_a_law_within_a_weighed_residual_is_proven_over_the_whole_band() -> None:
    limit = residual_vibration(spectrum=SPECTRUM, damping=0.02)
    problem = Problem(order=3, basis=Chebyshev(9), bounds={limit: at_most(0.1)})
    solution = synthesize(problem)
    assert solution.status.value == "optimal"
    assert weighed(solution.law, np.linspace(16.0, 27.0, 11_001), 0.02).max() == pytest.approx(0.1, rel=1e-6)
    checked = verify(solution.to_dict())
    assert "\nproven      optimal: the proven gap" in str(checked)
    assert f"\nproven      {limit.name} at most" in str(checked)
    assert Problem.from_dict(problem.to_dict()) == problem
    # what claims to leave less, or to keep to a heavier weight, is refused
    data = solution.to_dict()
    for name, most in ((limit.name, 0.099), (limit.name.replace("18.0:1.0", "18.0:1.1"), 0.1)):
        data["problem"]["bounds"] = {name: [None, most]}
        assert "\nnot proven" in str(verify(data))


def test_a_weight_that_is_even_is_a_scale_in_however_many_parts() -> None:
    plain = synthesize(
        Problem(order=3, basis=Chebyshev(7), bounds={residual_vibration(frequency=(16, 22)): at_most(0.1)})
    )
    for nu in ((16.0, 22.0), (16.0, 17.5, 19.0, 22.0)):
        even = residual_vibration(spectrum=[(x, 3.0) for x in nu])
        solution = synthesize(Problem(order=3, basis=Chebyshev(7), bounds={even: at_most(0.3)}))
        assert solution.status.value == "optimal"
        assert solution.objective == pytest.approx(plain.objective, rel=1e-9)
    part = residual_vibration(spectrum=SPECTRUM, frequency=(18.0, 19.0))
    assert part.value(smoothstep(4)) <= residual_vibration(spectrum=SPECTRUM).value(smoothstep(4))


def test_a_spectrum_is_read_from_a_file_and_covered_by_fewer_points(tmp_path: Path) -> None:
    file = tmp_path / "shaker.csv"
    hertz = np.linspace(20.0, 60.0, 801)
    sizes = 1.0 / np.abs(1.0 - (hertz / 33.0) ** 2 + 0.08j * hertz / 33.0)
    rows = "\n".join(f"{f:.2f};{a:.6f}".replace(".", ",") for f, a in zip(hertz, sizes, strict=True))
    file.write_text(f"frequency Hz;amplitude\n{rows}\n")
    assert np.array(read_spectrum(file, duration="100 ms")) == pytest.approx(
        np.column_stack([0.2 * np.pi * hertz, np.round(sizes, 6)])
    )
    nu, amplitude = np.array(read_spectrum(file, duration="100 ms", points=25)).T
    assert len(nu) == 25
    assert nu[[0, -1]] == pytest.approx(0.2 * np.pi * hertz[[0, -1]])
    assert (np.interp(0.2 * np.pi * hertz, nu, amplitude) >= np.round(sizes, 6) - 1e-12).all()
    named = Problem(order=3, basis=Chebyshev(5), bounds={f"residual(spectrum='{{{file}}}', duration=0.1)": (0, 1)})
    assert "spectrum='{12.566" in str(named)
    assert above([1.0, 2.0], [1.0, 2.0], 5) == ((1.0, 1.0), (2.0, 2.0))


@pytest.mark.parametrize("line", range(6))
def test_damaged_lines_are_refused_with_their_file(line: int, tmp_path: Path) -> None:
    lines = ["Hz,amplitude", "30,0.2", "31,0.5", "32,1.0", "33,0.5", "35,0.3"]
    file = tmp_path / "shaker.csv"
    file.write_text("\n".join([*lines[:line], "what,is this", *lines[line + 1 :]]))
    if line in {0, 1, 5}:  # a heading, or below the last numbers
        assert len(read_spectrum(file)) in {4, 5}
        return
    with pytest.raises(InputError, match=rf"shaker\.csv, line {line + 1}: a point is two numbers"):
        read_spectrum(file)


@pytest.mark.sample(9)
@pytest.mark.parametrize("points", [9, 33, 65])
@pytest.mark.parametrize("size", [1e-12, 1.0, 1e9])
def test_few_points_are_above_and_near_what_was_measured(points: int, size: float) -> None:
    nu = np.linspace(5.0, 54.5, 400)
    sizes = size / (1.0 + ((nu - 20.0) / 3.0) ** 2)
    covered = above(nu, sizes, points)
    assert len(covered) == points
    over = np.interp(nu, *np.array(covered).T) - sizes
    assert over.min() >= -1e-12 * size
    assert over.max() <= 10.0 * size / points**2
    law = synthesize(Problem(order=4, B=1.7)).law
    dense = np.linspace(5.0, 54.5, 200_001)
    known = (dense**2 * np.abs(residual_phasor(law, dense)) * np.interp(dense, nu, sizes)).max()
    found = residual_vibration(spectrum=covered).value(law)
    assert known * (1.0 - 1e-9) <= found <= known * (1.0 + 12.0 / points**2)


def measured(seed: int, points: int, size: float = 1.0, *, noise: float = 0.1) -> np.ndarray:
    """Six resonances and noise, at places that are not even, as pairs of a frequency and an amplitude."""
    numbers = np.random.default_rng(seed)
    nu = 5.0 + 55.0 * np.sort(numbers.uniform(size=points)) ** numbers.uniform(0.7, 1.5)
    sizes = np.full(points, 0.01)
    for centre, width, height in zip(
        numbers.uniform(6, 58, 6), numbers.uniform(0.3, 2, 6), numbers.uniform(0.3, 1, 6), strict=True
    ):
        sizes += height / (1.0 + ((nu - centre) / width) ** 2)
    return np.column_stack([nu, size * sizes * np.exp(noise * numbers.normal(size=points))])


@pytest.mark.sample(3)
@pytest.mark.parametrize(("points", "size"), [(60, 1e-9), (300, 1e9), (1000, 1e-3), (2000, 1.0), (5000, 1e6)])
@pytest.mark.parametrize("damping", [0.0, 0.03])
def test_the_greatest_is_that_of_the_whole_table(points: int, size: float, damping: float) -> None:
    law = synthesize(Problem(order=4, B=1.7)).law
    for seed in range(1 + 1000 // points):
        pairs = measured(seed, points, size)
        peak = residual_vibration(spectrum=pairs, damping=damping).peak(law)
        shares = np.linspace(0.0, 1.0, max(4, 4000 // points))
        dense = (pairs[:-1, :1] + shares * np.diff(pairs[:, :1], axis=0)).ravel()
        amplitudes = residuals(law.b, dense, damping)
        known = (np.interp(dense, *pairs.T) * amplitudes).max()
        assert known * (1.0 - 1e-12) <= peak.value <= known * (1.0 + 1e-3)
        there = np.array([peak.k])
        at_peak = np.interp(there, *pairs.T) * residuals(law.b, there, damping)
        assert peak.value == pytest.approx(float(at_peak[0]), rel=1e-11)


@pytest.mark.parametrize("minimise", [True, False])
def test_optima_of_many_rows_are_proven_in_all_units(*, minimise: bool) -> None:
    for seed, size in ((1, 1e-9), (2, 1e9)):
        limit = residual_vibration(spectrum=measured(seed, 120, size), damping=0.02)
        if minimise:
            problem = Problem(order=3, basis=Chebyshev(7), minimise=limit, B=at_most(2), C=at_most(7))
        else:
            problem = Problem(order=3, basis=Chebyshev(7), bounds={limit: at_most(0.5 * limit.value(smoothstep(4)))})
        best = synthesize(problem)
        assert best.status.value == "optimal"
        assert best.gap <= 1e-9


@pytest.mark.long
@pytest.mark.parametrize(("points", "size"), [(100, 1e9), (700, 1e-9), (2000, 1.0)])
def test_an_optimum_of_a_whole_table_is_proven_from_its_file(points: int, size: float) -> None:
    pairs = measured(points, points, size)
    limit = residual_vibration(spectrum=pairs, damping=0.02)
    most = 0.5 * limit.value(smoothstep(4))
    solution = synthesize(Problem(order=3, basis=Chebyshev(9), bounds={limit: at_most(most)}, symmetric=False))
    dense = np.interp(np.arange(0, points - 1, 0.05), np.arange(points), pairs[:, 0])
    weighed_by_table = np.interp(dense, *pairs.T) * residuals(solution.law.b, dense, 0.02)
    assert 0.999 * most <= weighed_by_table.max() <= most * (1.0 + 1e-9)
    data = solution.to_dict()
    assert "\nproven      optimal: the proven gap" in str(verify(data))
    name = data["problem"]["bounds"].popitem()[0]
    data["problem"]["bounds"] = {name: [None, 0.99 * most]}
    assert "\nnot proven" in str(verify(data))


def test_a_long_spectrum_does_not_fill_a_message() -> None:
    limit = residual_vibration(spectrum=measured(0, 500), damping=0.02)
    with pytest.raises(InfeasibleProblem) as refused:
        synthesize(Problem(order=3, basis=Chebyshev(5), bounds={limit: at_most(1e-3)}))
    assert "has residual weighed by a spectrum of 500 points, nu from 5.11115 to 59.8826 <= 0.001. A" in str(
        refused.value
    )
    assert len(refused.value.args[0] + refused.value.tried) < 500
    assert "at frequency = " in refused.value.tried


def bounded(order: int, **entries: Any) -> Any:
    return synthesize(Problem(order=order, bounds={residual_vibration(frequency=(18, 22), **entries): at_most(0.1)}))


def weighted(spectrum: object) -> Any:
    return residual_vibration(spectrum=spectrum)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: residual_vibration(frequency=(22, 18)), "frequency must be an interval"),
        (lambda: residual_vibration(frequency=(1, 2, 3)), "a frequency or two"),  # type: ignore[arg-type]
        (lambda: residual_vibration(frequency=(0, 3)), "frequency must be above 0"),
        (lambda: residual_vibration(frequency=(1, 3000)), "no longer than 1000"),
        (lambda: residual_vibration(frequency=20, damping=1.0), "damping must be below 1"),
        (lambda: residual_vibration(frequency=20, design_damping=0.1), "give design too"),
        (residual_vibration, "needs a frequency"),
        (lambda: residual_vibration(frequency=18, duration="1 s"), "of a spectrum in Hz"),
        (
            lambda: residual_vibration(spectrum=SPECTRUM, frequency=(10, 20)),
            "known from 16 to 27, and the frequencies are 10 to 20",
        ),
        (lambda: bounded(3, design=20), "order 4 at least"),
        (lambda: bounded(1), "rest to rest"),
        (lambda: weighted([(18, 1.0)]), "two frequencies at least"),
        (lambda: weighted([(20, 1.0), (18, 1.0)]), "increasing"),
        (lambda: weighted([(0, 1.0), (18, 1.0)]), "above 0"),
        (lambda: weighted([(18, -1.0), (20, 1.0)]), "at least 0"),
        (lambda: weighted([(18, 0.0), (20, 0.0)]), "one is above"),
        (lambda: weighted([(18, 1.0, 2.0), (20, 1.0)]), "pairs"),
        (lambda: weighted(7), "pairs"),
        (lambda: weighted("{18: one, 20: 1}"), "as text"),
        (lambda: weighted([(x, 1.0) for x in range(1, 20_002)]), "20000 points at most"),
        (lambda: weighted("{gone.csv}"), "cannot read gone.csv"),
        (lambda: weighted([(18, float("nan")), (20, 1.0)]), "amplitude"),
    ],
)
def test_what_is_no_residual_is_refused(call: Callable[[], Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        call()
