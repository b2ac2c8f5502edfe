"""Advice: its numbers against independent ones, its rule against its rows, its words against its numbers."""

import json
from math import inf, pi, tau

import numpy as np
import pytest

import optlaws
from optlaws import (
    Advice,
    Chebyshev,
    ConstantVelocity,
    Cycle,
    Drive,
    Dwell,
    Free,
    InfeasibleProblem,
    InputError,
    Mechanism,
    Motor,
    Move,
    Problem,
    Return,
    Rise,
    advise,
    at_most,
    catalogue,
    compare_laws,
    synthesize,
)
from tests.internals.shown import steps

FOLLOWER = {"frequency": ("27 Hz", "33 Hz"), "damping": 0.05}
STANDARD = ("modified sine", "modified trapezoid", "cycloidal", "3-4-5 polynomial", "4-5-6-7 polynomial")
BETTERED = "least acceleration, no worse than modified sine"


@pytest.fixture(scope="module")
def rise() -> Advice:
    return advise(Rise("35 mm", "0.1 s"), follower=FOLLOWER, drive={"mass": "2 kg"}, points=4)


def test_standard_laws_have_the_numbers_of_a_comparison(rise: Advice) -> None:
    nu = tau * 27.0 * 0.1, tau * 33.0 * 0.1
    known = compare_laws(*STANDARD, stroke="35 mm", duration="0.1 s", frequency=nu, damping=0.05)
    for law, row in zip(rise, known.rows, strict=False):
        values = law.values
        assert (law.name, law.kind, law.proof, law.solution) == (row["law"], "standard", None, None)
        for name, column in (
            ("velocity", "velocity, m/s"),
            ("acceleration", "acceleration, m/s²"),
            ("jerk", "jerk, m/s³"),
        ):
            assert values[name] == pytest.approx(row[column], rel=1e-12)
        assert values["residual acceleration"] == pytest.approx(float(row["residual"]) * 3.5, rel=1e-12)
        assert values["rms acceleration"] == pytest.approx(float(row["rms_c"]) * 3.5, rel=1e-12)
        assert values["force"] == pytest.approx(2.0 * values["acceleration"], rel=1e-9)
        # all kinetic energy of a move is given before it is taken back
        assert values["energy"] == pytest.approx(values["velocity"] ** 2, rel=1e-9)
        assert values["power"] == pytest.approx(2.0 * float(row["D"]) * 0.035**2 / 0.1**3, rel=1e-9)


def test_optimal_laws_are_recomputed_from_samples_and_proven_by_their_certificates(rise: Advice) -> None:
    k = np.linspace(0.0, 1.0, 20_001)
    optimal = list(rise)[len(STANDARD) :]
    assert len(optimal) >= 6
    for law in (*optimal, *rise.front):
        assert law.kind == "optimal"
        assert law.solution is not None
        assert law.proof is not None
        for nu, name in enumerate(("velocity", "acceleration", "jerk"), 1):
            sampled = np.abs(law.law(k, nu)).max() * 0.035 / 0.1**nu
            assert law.values[name] * (1.0 - 1e-5) <= sampled <= law.values[name] * (1.0 + 1e-12)
        least = law.proof.minimise
        scale = {"acceleration": 3.5, "residual acceleration": 3.5, "jerk": 35.0, "rms acceleration": 3.5}[least]
        assert law.solution.certificate.bound * scale == pytest.approx(law.proof.lower_bound, rel=1e-9)
        assert law.values[least] == pytest.approx(law.proof.lower_bound, rel=1e-7)
    # of no degree below: 4 h/T² of the acceleration, 32 h/T³ of the jerk
    assert rise["least acceleration"].proof.best_possible == pytest.approx(4.0 * 3.5)  # type: ignore[union-attr]
    assert rise["least jerk"].proof.best_possible == pytest.approx(32.0 * 35.0)  # type: ignore[union-attr]


def test_the_bettered_law_is_the_solution_of_its_problem() -> None:
    advice = advise(Rise("35 mm", "0.1 s"), points=0)
    sine = optlaws.catalogue["modified sine"].law.constants
    problem = Problem(order=3, basis=Chebyshev(21), B=at_most(sine.B.value), J=at_most(sine.J.value))
    known = synthesize(problem)
    bettered = advice[BETTERED]
    assert bettered.values["acceleration"] == pytest.approx(3.5 * known.objective, rel=1e-9)
    assert known.best_possible is not None
    assert bettered.proof is not None
    assert bettered.proof.best_possible == pytest.approx(3.5 * known.best_possible, rel=1e-9)


def test_the_rule_is_kept_and_its_words_are_the_rows(rise: Advice) -> None:
    chosen, usual = rise.recommendation, rise["modified sine"]
    assert chosen.usual is usual
    # the force of a mass alone is its acceleration, and no motor is rated by its root mean square
    assert {"velocity", "jerk", "residual acceleration"} == set(rise.guarded)
    fit = [
        law
        for law in rise
        if all(law.values[name] <= usual.values[name] * (1.0 + 1e-6) for name in (*rise.guarded, "acceleration"))
    ]
    least = min(law.values["acceleration"] for law in fit)
    good = [law for law in fit if law.values["acceleration"] <= 1.01 * least * (1.0 + 1e-9)]
    assert chosen.law is min(good, key=lambda law: law.values["residual acceleration"])
    assert usual in fit
    assert len(fit) >= 3
    gain = 1.0 - chosen.law.values["acceleration"] / usual.values["acceleration"]
    assert chosen.gain == pytest.approx(gain)
    assert 0.03 < gain < 0.2
    first, second = chosen.sentences
    assert (
        f"{chosen.law.values['acceleration']:.5g} m/s², {100.0 * gain:.3g} % less than that of modified sine" in first
    )
    bound = rise[BETTERED].proof.lower_bound  # type: ignore[union-attr]
    assert f"at least {bound:.5g} m/s²" in second
    assert "58 % less residual acceleration" in second
    assert chosen.changes["residual acceleration"] == pytest.approx(0.424, abs=5e-3)


@pytest.mark.parametrize(
    ("motion", "entries"),
    [
        (Rise("35 mm", "0.1 s"), {"drive": {"mass": "2 kg"}}),
        (Rise("35 mm", "110 deg"), {"speed": "183.333333333333333 rpm"}),
        (Cycle([Rise("35 mm", "0.1 s"), Dwell()], period="0.3 s", advance="35 mm"), {}),
        (
            Cycle([Rise("35 mm", "110 deg"), Dwell()], period="1 s", advance="35 mm"),
            {"speed": "183.333333333333333 rpm"},
        ),
    ],
)
def test_one_move_gives_one_advice(motion: Rise | Cycle, entries: dict[str, object]) -> None:
    known, other = advise(Rise("35 mm", "0.1 s"), points=3), advise(motion, points=3, **entries)  # type: ignore[arg-type] # of each
    assert other.recommendation.rule == known.recommendation.rule
    assert other.recommendation.sentences[0] == known.recommendation.sentences[0]
    assert other.recommendation.sentences[1].split(";")[0] == known.recommendation.sentences[1].split(";")[0]
    assert "Z of degree 21" in known.recommendation.sentences[1]
    for one, law in zip(known.front, other.front, strict=True):
        assert law.values["acceleration"] == pytest.approx(one.values["acceleration"], rel=1e-6)


@pytest.mark.parametrize(
    ("given", "degree", "minimise"),
    [(9, None, "acceleration"), (21, None, "acceleration"), (9, 9, "acceleration"), (9, 7, "power")],
)
def test_advice_of_a_cycle_names_its_own_degree_and_that_of_the_cycle(
    given: int, degree: int | None, minimise: str
) -> None:
    limits = {"acceleration": "19.4 m/s^2", "jerk": "2500 m/s^3", "velocity": "620 mm/s"}
    drive = {"mass": "3 kg", "stiffness": "2 N/mm", "preload": "20 N"}
    moves = [Rise("35 mm", "0.1 s"), Dwell()]
    cycle = Cycle(moves, period="0.3 s", advance="35 mm", degree=given, drive=drive, minimise=minimise, limits=limits)
    second, searched = advise(cycle, points=0, degree=degree).recommendation.sentences[1], degree or 21
    assert second.startswith(f"Proven: laws of order 3 with Z of degree {searched}")
    words = f"the laws of this advice have a Z of degree {searched}, those of the cycle as it is given {given}: "
    assert (words in second) == (given != searched)


def test_an_rms_guards_where_a_motor_is_rated_by_it_and_the_front_obeys() -> None:
    weak, rated = (
        Drive(Mechanism("0.8 kg m^2", viscous="3 N m s/rad"), Motor("3e-4 kg m^2", rated_torque=most), ratio=20)
        for most in (None, "2 N m")
    )
    move = Rise("45 deg", "0.25 s")
    assert advise(move, drive=weak, points=0, degree=5).guarded == ("velocity", "jerk", "torque")
    advice = advise(move, drive=rated, points=3, degree=5)
    assert advice.guarded == ("velocity", "jerk", "torque", "rms torque")
    usual = advice["modified sine"].values
    for law in advice.front:
        assert all(law.values[name] <= usual[name] * (1.0 + 1e-6) for name in ("velocity", "torque", "rms torque"))
    calm = advise(move, drive=rated, points=0, degree=9, follower={"frequency": "20 Hz"})
    calmest = calm["least residual acceleration, no worse than modified sine"].values
    assert all(calmest[name] <= usual[name] * (1.0 + 1e-6) for name in advice.guarded)


def test_points_below_the_front_take_more_of_what_its_legend_names(rise: Advice) -> None:
    usual = rise["modified sine"].values
    bounds = [(law.values["residual acceleration"], law.proof.lower_bound or 0.0) for law in rise.front if law.proof]
    assert len(bounds) == len(rise.front)
    for law in rise:
        x, y = law.values["residual acceleration"], law.values["acceleration"]
        below = any(x <= at * (1.0 + 1e-9) and y < least * (1.0 - 1e-7) for at, least in bounds)
        assert not below or any(law.values[name] > usual[name] for name in ("velocity", "jerk"))
    labels = [str(artist.get_label()) for artist in rise.plot()]
    assert "lower bound of laws with no more velocity or jerk than modified sine" in labels
    assert "open markers: more velocity or jerk than modified sine" in labels


def test_the_front_exchanges_one_for_the_other_and_no_law_betters_it(rise: Advice) -> None:
    residuals = [law.values["residual acceleration"] for law in rise.front]
    accelerations = [law.values["acceleration"] for law in rise.front]
    assert len(rise.front) == 4
    assert residuals == sorted(residuals, reverse=True)
    assert accelerations == sorted(accelerations)
    limits = {name: rise["modified sine"].values[name] for name in ("velocity", "jerk")}
    for law in rise:
        if all(law.values[name] <= most * (1.0 + 1e-9) for name, most in limits.items()):
            for point in rise.front:
                no_calmer = law.values["residual acceleration"] > point.values["residual acceleration"]
                assert no_calmer or law.values["acceleration"] >= point.values["acceleration"] * (1.0 - 1e-7)


@pytest.mark.sample(3)
@pytest.mark.parametrize(("length", "time"), [("35e-9 mm", "1e-4 s"), ("35e9 mm", "1e5 s"), ("0.035 m", "100 ms")])
def test_other_units_are_the_same_advice(length: str, time: str) -> None:
    advice, known = (
        advise(Rise(*given), points=0, laws=["cycloidal", "modified sine"], degree=9)
        for given in ((length, time), ("35 mm", "0.1 s"))
    )
    scale = advice["cycloidal"].values["acceleration"] / known["cycloidal"].values["acceleration"]
    assert [law.name for law in advice] == [law.name for law in known]
    for law, other in zip(advice, known, strict=True):
        assert law.values["acceleration"] == pytest.approx(scale * other.values["acceleration"], rel=1e-6)
    assert advice.recommendation.law.name == known.recommendation.law.name
    assert advice.recommendation.gain == pytest.approx(known.recommendation.gain, rel=1e-6)


def press(law: str = "optimal", **entries: object) -> Cycle:
    moves = [Rise("35 mm", "120 deg", law=law), Dwell("90 deg"), Return("35 mm", "100 deg", law=law), Dwell()]
    return Cycle(moves, speed="200 rpm", **entries)  # type: ignore[arg-type] # whatever a test gives


def test_a_cycle_has_each_law_in_its_moves_and_its_limits_are_looked_at() -> None:
    advice = advise(press(limits={"velocity": "616 mm/s", "acceleration": "30 m/s^2"}), points=3)
    for name in STANDARD:
        known = press(name)
        assert [advice[name].values[each] for each in ("velocity", "jerk")] == [known.peak(1), known.peak(3)]
        assert not advice[name].keeps_limits
    (velocity,) = advice["modified sine"].broken
    assert (velocity.name, velocity.where) == ("velocity", "segment 3 (Return)")
    assert velocity.share == pytest.approx(press("modified sine").peak(1) / 0.616)
    least = press(limits={"velocity": "616 mm/s"}, degree=21)
    assert advice["least acceleration"].values["acceleration"] == pytest.approx(least.objective, rel=1e-9)
    chosen = advice.recommendation
    # more would be taken than the usual law takes, which breaks a limit: it guards nothing
    assert (chosen.usual, advice.guarded) == (advice["modified sine"], ())
    assert "% of it takes" in chosen.sentences[1]
    assert chosen.law.values["acceleration"] == pytest.approx(1.01 * least.objective, rel=1e-6)
    assert "none of the 5 standard laws does: modified sine has 20 % more velocity than 616 mm/s" in chosen.sentences[0]
    assert all(law.values["velocity"] <= 0.616 * (1.0 + 1e-9) for law in advice.front)
    with pytest.raises(InputError, match="its 2 motions have laws of their own"):
        _ = chosen.law.law
    assert len(chosen.law.solutions) == 2
    assert advice["cycloidal"].law == optlaws.catalogue["cycloidal"].law


def test_the_law_that_a_cycle_has_is_the_usual_one() -> None:
    advice = advise(press("cycloidal"), points=0)
    usual = advice.recommendation.usual
    assert usual is not None
    assert usual.name == "cycloidal"
    assert len(advice) == 10
    assert advice.recommendation.law.values["jerk"] <= usual.values["jerk"]
    mixed = Cycle([Rise("35 mm", "0.1 s", law="cycloidal"), Return(law="modified sine")], period="0.25 s")
    advice = advise(mixed, points=0)
    assert next(iter(advice)).kind == "given"
    assert next(iter(advice)).values["jerk"] == mixed.peak(3)
    assert advice.recommendation.usual is next(iter(advice))


def test_a_standard_law_that_keeps_limits_takes_the_place_of_one_that_does_not() -> None:
    limits = {"jerk": "2200 m/s^3"}
    advice = advise(Rise("35 mm", "0.1 s", limits=limits), points=0)
    kept = [law for law in advice if law.kind == "standard" and law.keeps_limits]
    assert "modified sine" not in [law.name for law in kept]
    assert len(kept) == 4
    assert advice.recommendation.usual is min(kept, key=lambda law: law.values["acceleration"])


def test_a_limit_of_the_residual_is_kept_and_none_may_be_possible() -> None:
    limits = {"residual acceleration": "8 m/s^2"}
    advice = advise(Rise("35 mm", "0.1 s"), follower=FOLLOWER, limits=limits, points=0)
    assert "residual acceleration" not in advice.guarded
    least = advice["least acceleration"]
    assert least.values["residual acceleration"] <= 8.0 * (1.0 + 1e-9)
    assert least.keeps_limits
    assert least.values["acceleration"] > 14.4
    assert [taken.name for taken in advice["modified sine"].broken] == ["residual acceleration"]
    with pytest.raises(InfeasibleProblem):
        advise(Rise("35 mm", "0.1 s"), follower=FOLLOWER, limits={"residual acceleration": "1 mm/s^2"}, degree=5)


def test_a_limit_of_the_sway_is_kept_and_its_values_are_those_of_the_oscillator() -> None:
    sway, omega, limits = "residual displacement", tau * 12.0, {"residual displacement": "1 mm"}
    follower = {"frequency": "12 Hz", "damping": 0.0}
    advice = advise(Rise("35 mm", "0.1 s"), follower=follower, limits=limits, points=0, degree=13)
    k = np.linspace(0.0, 1.0, 20_001)
    for law in advice:
        wave = 0.035 * law.law.c(k) / 0.1**2 * np.exp(1j * omega * 0.1 * k)
        amplitude = abs(np.trapezoid(wave, 0.1 * k)) / omega
        assert law.values[sway] == pytest.approx(amplitude, rel=1e-5, abs=1e-9)
        assert law.keeps_limits == (law.values[sway] <= 1e-3 * (1.0 + 1e-9))
    least = advice["least acceleration"]
    assert least.values[sway] == pytest.approx(1e-3, rel=1e-9)
    assert sway not in advice.guarded
    assert [taken.text for taken in advice["modified sine"].broken] == ["1 mm"]
    calm = advise(Rise("35 mm", "0.1 s"), follower=follower, minimise=sway, points=0, degree=13)
    calmest = calm[f"least {sway}, no worse than modified sine"]
    assert calmest.proof is not None
    assert calmest.values[sway] == pytest.approx(calmest.proof.lower_bound, rel=1e-6, abs=1e-12)
    with pytest.raises(InputError, match="are of one vibration: name one"):
        advise(Rise("35 mm", "0.1 s"), follower=follower, limits=limits, minimise="residual acceleration")


def test_a_motor_is_asked_for_what_it_takes() -> None:
    motor = Motor("3e-4 kg m^2", rated_torque="2 N m", peak_torque="4 N m", greatest_speed="3000 rpm")
    drive = Drive(Mechanism("0.8 kg m^2"), motor, ratio=20)
    index = Cycle(
        [Rise("45 deg", "0.25 s"), Dwell()], period="0.6 s", advance="45 deg", drive=drive, limits={"motor": True}
    )
    advice = advise(index, points=0, laws=["modified sine", "4-5-6-7 polynomial"])
    for law in advice:
        sheet = law.motion.sheet
        assert law.values["torque"] == sheet.peak_torque
        assert law.values["rms torque"] == sheet.rms_torque
        assert law.values["energy"] == pytest.approx(sheet.energy)
        assert law.keeps_limits == sheet.fits
    assert not advice["4-5-6-7 polynomial"].keeps_limits
    assert advice["modified sine"].keeps_limits
    inertia = 0.8 / 20.0 + 3e-4 * 20.0
    sine = advice["modified sine"].values
    assert sine["torque"] == pytest.approx(inertia * sine["acceleration"], rel=1e-9)
    # without losses and load the torque is the acceleration's, so that one law is least in both
    least = advice["least RMS acceleration"]
    assert least is advice["least rms acceleration"]  # as names of laws were spelled
    assert least.values["rms torque"] < sine["rms torque"]
    assert "least RMS torque" not in [law.name for law in advice]


def test_standard_laws_stand_on_the_uniform_motion_between_equal_velocities() -> None:
    web = Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms", degree=9)
    shear = advise(web, points=0, degree=9)
    assert shear.errors == {}
    for name in STANDARD:
        beside = 1.5 * 0.4 / 0.32**2  # what the return takes back beside the uniform motion
        assert shear[name].values["acceleration"] == pytest.approx(catalogue[name].law.constants.C.value * beside)
    assert shear.recommendation.usual is shear["modified sine"]


def test_what_cannot_be_compared_says_why() -> None:
    slowed = [ConstantVelocity("1.5 m/s", "80 ms"), Move("-60 mm", "120 ms"), Dwell("80 ms"), Return()]
    web = Cycle(slowed, period="400 ms", degree=9)
    shear = advise(web, points=0, degree=9)
    assert set(shear.errors) == set(STANDARD)
    assert "a jump of 1500 mm/s" in str(shear.errors["modified sine"])
    assert [law.kind for law in shear] == ["optimal"] * len(shear)
    assert shear.recommendation.usual is None
    with pytest.raises(InputError, match="law of this advice"):
        _ = shear["modified sine"]
    points = [Dwell("0.1 s"), Free("30 mm", "0.2 s", via=[("0.1 s", "10 mm")]), Free("-30 mm", "0.3 s"), Dwell()]
    through = advise(Cycle(points, period="1 s"), points=0, laws=["cycloidal"])
    assert "passes no points" in str(through.errors["cycloidal"])
    assert "least jerk" in [law.name for law in through]
    with pytest.raises(InputError, match="no move whose law could be another"):
        advise(Cycle([Dwell()], period="1 s"))


@pytest.mark.parametrize(
    ("motion", "entries", "complaint"),
    [
        ("modified sine", {}, "advice is of a move such as Rise"),
        (Rise("35 mm", "120 deg"), {}, "is an angle of the master: give its speed too"),
        (Rise("35 mm"), {}, "a single move has one duration"),
        (Rise("35 mm", "0.1 s"), {"minimise": "beauty"}, "beauty"),
        (Rise("35 mm", "0.1 s"), {"minimise": "residual acceleration"}, "is that of a follower: give follower="),
        (Rise("35 mm", "0.1 s"), {"limits": {"residual acceleration": "1 m/s^2"}}, "is that of a follower"),
        (Rise("35 mm", "0.1 s"), {"follower": {"damping": 0.1}}, "needs its frequency"),
        (Rise("35 mm", "0.1 s"), {"follower": {"frequency": "3 mm"}}, "frequency"),
        (Rise("35 mm", "0.1 s"), {"laws": "cycloidal"}, "laws must be names such as"),
        (Rise("35 mm", "0.1 s"), {"points": -1}, "points must be"),
        (Rise("35 mm", "0.1 s"), {"drive": {"inertia": "2 kg"}}, "inertia"),
        (Problem(order=3), {}, r"advice is of a move .* or of a Cycle, .*: Rise\('1 m', '1 s', limits=...\)"),
    ],
)
def test_a_wrong_entry_is_refused(motion: object, entries: dict[str, object], complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        advise(motion, **entries)  # type: ignore[arg-type] # that is the point


def test_the_residual_may_be_what_is_least_and_a_swing_is_in_radians() -> None:
    advice = advise(
        Return("45 deg", "0.2 s"), follower={"frequency": "12 Hz"}, minimise="residual acceleration", points=0
    )
    assert advice.minimise == "residual acceleration"
    assert advice.measures[1].unit == "rad/s²"
    sine = optlaws.residual_vibration(frequency=tau * 12.0 * 0.2).value(optlaws.catalogue["modified sine"].law)
    values = advice["modified sine"].values
    assert values["residual acceleration"] == pytest.approx(sine * 0.25 * pi / 0.2**2, rel=1e-9)
    calm = advice["least residual acceleration, no worse than modified sine"]
    assert calm.proof is not None
    assert calm.values["residual acceleration"] == pytest.approx(calm.proof.lower_bound, rel=1e-7)
    assert calm.values["residual acceleration"] < 0.6 * values["residual acceleration"]
    assert advice.recommendation.law.values["jerk"] <= values["jerk"] * (1.0 + 1e-6)


def test_an_advice_leaves_as_plain_data_a_table_and_a_picture(rise: Advice) -> None:
    data = json.loads(json.dumps(rise.report().data))
    assert data["recommendation"]["law"] == rise.recommendation.law.name
    assert [law["name"] for law in data["laws"]] == [law.name for law in rise]
    assert rise.headings[:2] == ("law", "velocity, m/s")
    assert len(rise.rows) == len(rise)
    assert list(rise.proofs()["laws"]) == [law.name for law in rise if law.solutions]
    rows = {row.name: row for row in rise.summary()}
    assert rows["recommended"].value == rise.recommendation.law.name
    assert rows["acceleration"].value == rise.recommendation.law.values["acceleration"]
    labels = [artist.get_label() for artist in rise.plot()]
    assert labels[0] == "front"
    assert labels[-1] == "recommended law"
    assert {"standard laws", "optimal laws"} <= set(labels)
    assert "<table>" in rise._repr_html_()
    assert str(rise) in rise._repr_html_().replace("&quot;", '"')
    harmonic = advise(Rise("35 mm", "0.1 s"), laws=["simple harmonic"], points=2, degree=13)
    assert harmonic["simple harmonic"].values["jerk"] == inf
    assert json.loads(json.dumps(harmonic.report().data))["laws"][0]["values"]["jerk"] is None
    assert harmonic.plot()
    assert harmonic.recommendation.law.name != "simple harmonic"


def test_a_value_that_a_cycle_has_not_is_refused() -> None:
    for name, says in (("beauty", "beauty"), ("energy", "are of a drive")):
        with pytest.raises(InputError, match=says):
            press().value(name)


def test_each_law_that_is_looked_for_is_a_step_of_the_work() -> None:
    seen: list[str] = []
    with steps.shown_by(lambda text, _: seen.append(text)):
        advice = advise(Rise("35 mm", "0.1 s"), points=3)
    looked_for = [law.name for law in advice.laws if law.kind == "optimal"]
    assert set(looked_for) <= set(seen)
    assert {"front, point 2 of 3", "front, point 3 of 3"} <= set(seen)


@pytest.mark.long
def test_a_bound_that_no_certificate_proves_alone_is_not_called_proven() -> None:
    load = {"period": "0.03 s", "mass": "2 kg", "damping": 0.02}
    moves = [Rise("35 mm", "0.1 s"), Return("35 mm", "0.12 s")]
    cycle = Cycle(moves, period="0.22 s", load=load, minimise="rms load acceleration", degree=7)
    advice = advise(cycle, points=0, laws=["modified sine"])
    assert "Computed in doubles: splines" in str(advice)
    assert "Proven" not in str(advice)
    assert advice["least rms load acceleration"].motion.lower_bound_name == "lower bound in doubles"
