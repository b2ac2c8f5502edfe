"""Flat outputs: the law that makes the last mass of a chain move as asked, and why other outputs have none."""

import numpy as np
import pytest

from optlaws import InputError, Link, Machine, driving_law, flat_output, polydyne, savin, smoothstep
from tests.internals.mechanisms import cam_factors


def chain(count: int, damping: float = 0.0) -> Machine:
    """Masses one behind the other, dampers to the ground only unless `damping`."""
    names = ["motor", *(f"m{i}" for i in range(1, count + 1))]
    masses = {name: 1.0 + 0.3 * i for i, name in enumerate(names)}
    links = [Link(names[i], names[i + 1], 300.0 + 50.0 * i, damping) for i in range(count)]
    links += [Link(name, "ground", 0.0, 0.5) for name in names[1:]]
    return Machine.from_masses(masses, links, drive="motor", outputs=[f"position {names[-1]}", "drive force"])


@pytest.mark.parametrize("count", [1, 2, 3])
def test_the_last_mass_moves_by_the_law_and_stays(count: int) -> None:
    machine, law = chain(count), smoothstep(2 * count + 2)
    driven = driving_law(machine, law)
    response = machine.response(driven, dwell=1.0)
    k = np.linspace(0.0, 1.0, 41)
    assert response[machine.outputs[0]](k) == pytest.approx(law(k), abs=1e-9)
    after = response[machine.outputs[0]].extrema(0, (1.0, 2.0))
    assert (after[0].value, after[1].value) == pytest.approx((1.0, 1.0), abs=1e-9)
    for mode in machine.modes:
        assert machine.residual(mode.number).value(driven) < 1e-9


def test_one_mass_is_a_polydyne_cam() -> None:
    nu, damping = 20.0, 0.05
    machine = Machine([[0, 1], [-(nu**2), -2 * damping * nu]], [[0], [nu**2]], [[1, 0]], outputs=["mass"])
    assert flat_output(machine) == pytest.approx((1.0, *map(float, cam_factors(nu, damping))), rel=1e-14)
    k = np.linspace(0.0, 1.0, 21)
    law = savin("III", 7.2)
    assert driving_law(machine, law)(k) == pytest.approx(polydyne(law, nu, damping)(k), abs=1e-13)


@pytest.mark.parametrize(
    ("says", "machine", "output"),
    [
        ("has zeros .-", chain(1, damping=2.0), None),
        ("enters it directly", chain(1), "drive force"),
        ("does not move it", Machine([[0, 1], [-9, 0]], [[0], [0]], [[1, 0]]), None),
        ("unknown output", chain(1), "torque"),
    ],
)
def test_outputs_that_are_not_flat_say_why(says: str, machine: Machine, output: str | None) -> None:
    with pytest.raises(InputError, match=says):
        flat_output(machine, output)


def test_laws_that_are_not_smooth_enough_are_refused() -> None:
    with pytest.raises(InputError, match="of order 4 at least"):
        driving_law(chain(1), smoothstep(3))
