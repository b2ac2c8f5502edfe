"""Spectra of machines over a parameter: those of followers, and of machines one by one."""

import numpy as np
import pytest

from optlaws import InputError, Machine, machine_spectrum, response_spectrum, savin


def follower(nu: float) -> Machine:
    C, D = [[-(nu**2), -0.1 * nu]], [[nu**2]]
    return Machine([[0, 1], [-(nu**2), -0.1 * nu]], [[0], [nu**2]], C, D, outputs=["acceleration"])


def test_a_followers_spectrum_is_its_own() -> None:
    nu, law = np.linspace(5.0, 40.0, 8), savin("III", 7.2)
    found, expected = machine_spectrum(follower, nu, law), response_spectrum(law, nu, 0.05)
    assert found.frequencies[:, 0] == pytest.approx(nu, rel=1e-12)
    assert found.residuals[:, 0] == pytest.approx(expected.residual_acceleration, rel=1e-9)
    assert found.peaks["acceleration"] == pytest.approx(expected.peak_acceleration, rel=1e-5)


def test_machines_with_fewer_modes_have_no_number_there() -> None:
    spectrum = machine_spectrum(
        lambda c: Machine([[0, 1], [-25, -c]], [[0], [25]], [[1, 0]]), [1.0, 20.0], savin("III", 0)
    )
    assert np.isnan(spectrum.residuals).ravel().tolist() == [False, True]


def belt(stiffness: float) -> Machine:
    return Machine.from_masses({"motor": 1.0, "load": 3.0}, [("motor", "load", stiffness, 0.5)], drive="motor")


def test_a_spectrum_is_drawn_and_tabled() -> None:
    spectrum = machine_spectrum(
        belt, [100.0, 400.0, 900.0], savin("III", 0), dwell=0.5, output="force motor-load", parameter="stiffness, N/m"
    )
    left = [belt(value).residual(1, "force motor-load").value(savin("III", 0)) for value in spectrum.values]
    assert spectrum.residuals[:, 0] == pytest.approx(left, rel=1e-12)
    peak, mode = spectrum.plot()
    assert (peak.axes.get_xlabel(), peak.axes.get_ylabel()) == ("stiffness, N/m", "force motor-load")
    assert peak.get_ydata() == pytest.approx(spectrum.peaks["force motor-load"])
    assert mode.get_ydata() == pytest.approx(left)
    table = spectrum.to_pandas()
    assert table.index.name == "stiffness, N/m"
    assert table["mode 1 left in force motor-load"].tolist() == pytest.approx(left)
    assert table["frequency of mode 1"].tolist() == pytest.approx(np.sqrt(spectrum.values / 3.0).tolist())


def test_what_is_no_machine_is_refused() -> None:
    with pytest.raises(InputError, match="values must be at least one"):
        machine_spectrum(belt, [], savin("III", 0))
    with pytest.raises(InputError, match="did you mean 'force motor-load'"):
        machine_spectrum(belt, [1.0], savin("III", 0), output="force motor load")
    with pytest.raises(InputError, match="make must give a Machine"):
        machine_spectrum(lambda _: 3, [1.0], savin("III", 0))  # type: ignore[arg-type,return-value]
    with pytest.raises(InputError, match="same outputs"):
        machine_spectrum(lambda s: Machine([[-s]], [[s]], [[1.0]], outputs=[f"at {s:g}"]), [1.0, 2.0], savin("III", 0))
