"""Tables that state what runs between their points: read as these functions, from two points on."""

from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import BPoly

from optlaws import InputError, MotionLaw, catalogue, read_cycle_table, read_law
from tests.internals.cli import exit_code
from tests.internals.cycles import hermite, law_of_move, position, stretches_of_pieces

QUINTIC = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])


def movers(prefix: str = "MC_MotionFunctionType.") -> str:
    """The second of two movers on a track of 1,500 mm: 60 mm behind in curves, 100 mm on straights, blends of 100 mm.

    The layout of a public writer of Structured Text, qualified enumerations and numbers by a variable; the programme is
    the first example of its collection for XTS (9 points, endless).
    """
    gaps = [(0, 60), (100, 100), (250, 100), (350, 60), (750, 60), (850, 100), (1000, 100), (1100, 60), (1500, 60)]
    lines = ["\t// Clothoid oval cam, 9 points, generated from cam-table.json.", "\t// Run it twice for a full lap."]
    for i, (master, gap) in enumerate(gaps):
        kind = "POLYNOM1" if i % 2 or i == len(gaps) - 1 else "POLYNOM5_MM"
        cell = "\t\t\t_Camming.camPoints[point]."
        lines += [
            f"\tpoint\t:= {i + 1};",
            f"{cell}MasterPos\t:= {master:.4f};",
            f"{cell}SlavePos\t:= {master - gap:.4f};",
            f"{cell}PointIndex\t:= point;",
            f"{cell}FunctionType\t:= {prefix}MOTIONFUNCTYPE_{kind};",
            f"{cell}PointType\t:= MC_MotionPointType.MOTIONPOINTTYPE_{'MOTION' if i else 'ACTIVATION'};",
            f"{cell}RelIndexNextPoint\t:= {int(i < len(gaps) - 1)};",
            f"{cell}SlaveVelo\t:= 1.0000000;",
            f"{cell}SlaveAcc\t:= 0.000000000;",
            f"{cell}SlaveJerk\t:= 0.00;",
        ]
    return "\n".join(
        [*lines, "\t_Camming.camRef.NoOfRows\t:= point;", "\t_Camming.camTableSelect( Periodic := TRUE );"]
    )


def test_functions_are_read_in_parts_of_units(tmp_path: Path) -> None:
    file = tmp_path / "movers.st"
    file.write_text(movers())
    table = read_cycle_table(file, unit="mm", master="mm", turn="1500 mm", advance="1500 mm")
    parts = read_cycle_table(file, unit="0.01 mm", master="0.1 mm", turn="150 mm", advance="15 mm")
    at = np.linspace(0.0, 1500.0, 1501)
    assert parts.at(0.1 * at) == pytest.approx(0.01 * table.at(at), abs=1e-12)
    assert [part.stop for part in parts.stretches] == pytest.approx([0.1 * part.stop for part in table.stretches])


@pytest.mark.parametrize("prefix", ["MC_MotionFunctionType.", "MC_MotionFunctionType#", ""])
def test_two_movers_are_lines_and_polynomials_over_a_track(prefix: str, tmp_path: Path) -> None:
    file = tmp_path / "movers.st"
    file.write_text(movers(prefix))
    table = read_cycle_table(file, unit="mm", master="mm", turn="1500 mm", advance="1500 mm")
    assert [(part.stop, part.law if isinstance(part.law, str) else "") for part in table.stretches] == [
        (100.0, ""), (250.0, "constant velocity"), (350.0, ""), (750.0, "constant velocity"),
        (850.0, ""), (1000.0, "constant velocity"), (1100.0, ""), (1500.0, "constant velocity"),
    ]  # fmt: skip
    peak = 40e-3 * 10 / np.sqrt(3) / (100 / 300) ** 2
    assert peak == pytest.approx(2.0785, abs=5e-5)
    cycle = table.cycle(speed="300 mm/s")
    assert cycle.peak(2) == pytest.approx(peak, rel=1e-12)
    assert [cycle.duration, float(cycle(0.0, 1))] == pytest.approx([5.0, 0.3])
    assert list(table.peaks[1]) == pytest.approx([peak / 90.0] * 2)
    assert "9 points" in f"{table.layout}, {len(table.places)} points"
    with pytest.raises(
        InputError, match="what runs from the last point, at 1500, to the end of the turn is not stated"
    ):
        read_cycle_table(file, unit="mm", master="mm", turn="1600 mm")
    file.write_text(movers(prefix).replace("MOTIONPOINTTYPE_MOTION", "MOTIONPOINTTYPE_IGNORE", 1))
    assert len(read_cycle_table(file, unit="mm", master="mm").places) == 8
    (tmp_path / "none.st").write_text(file.read_text().replace("TYPE_MOTION;", "TYPE_IGNORE;"))
    with pytest.raises(InputError, match=r"none\.st holds no points"):
        read_cycle_table(tmp_path / "none.st")
    part = read_cycle_table(file, unit="mm", master="mm", rows=3)
    assert [each.stop for each in part.stretches] == [350.0]  # one polynomial goes on in the next


#: as the manual of the ISG kernel prints it (kernel-html en-GB/179241611)
ENDLESS = """Tablename = EndlessNegative # Table name
Table-ID = 422 # Table-ID
Tabletype = 7 # Table type
Function type = 5 # Interpolation type
Lines = 6 # Number of lines
Begintable # Beginning of table
15000 0 # MasterPos[0] SlavePos[0]
450000 3400000 # MasterPos[1] SlavePos[1]
900000 2400000 # MasterPos[2] SlavePos[2]
1350000 2000000 # MasterPos[3] SlavePos[3]
2700000 1300000 # MasterPos[4] SlavePos[4]
3400000 300000 # MasterPos[5] SlavePos[5]
EndTable # End of table
"""
#: and that of TwinCAT CNC (infosys.beckhoff.com, 15306140811)
SMALLEST = """Tablename = Smallest_Table # Table name
Table-ID = 404 # Table ID
Tabletype = 7 # Table type, 7 = 2-column table, SGN32-Format
Functiontype = 4 # Type of interp., 4 = LINE-POLY5,5 = POLY5-LINE
Lines = 2 # Number of lines
Begintable # Begin of table
100000 0
1500000 3400000
EndTable
"""

#: and the one by which TwinCAT CNC explains its coefficients (infosys.beckhoff.com, 15306134667)
TEN = """Tablename = poly5line_2 # Table name
Table-ID = 402 # Table id
Tabletype = 7 # Table type
Functiontype = 5 # Type of interpolation, 5 = POLY5-LINE
Lines = 10 # Number of lines
Begintable # Begin of table
100000 0
200000 400000
400000 1600000
670000 1800000
900000 300000
980000 1700000
1500000 3400000
1800000 2700000
2700000 1700000
3000000 2600000
EndTable
"""


@pytest.mark.parametrize("text", [ENDLESS, SMALLEST, TEN])
def test_lines_and_polynomials_are_those_of_their_boundary_conditions(text: str, tmp_path: Path) -> None:
    (tmp_path / "cam.txt").write_text(text)
    table = read_cycle_table(tmp_path / "cam.txt", unit="deg")
    points = [tuple(map(float, line.split()[:2])) for line in text.splitlines() if line[0].isdigit()]
    x, y = np.array([*points, (points[0][0] + 3.6e6, points[0][1])]).T / 1e4
    slopes, count = np.diff(y) / np.diff(x), len(points)
    for i in range(count):
        places = np.linspace(x[i], x[i + 1], 41)
        if (i % 2 == 0) is ("type = 5" in text):
            assert table.at(places) == pytest.approx(np.interp(places, x, y), abs=1e-9)
        else:
            ends = [[y[i], slopes[i - 1], 0.0], [y[i + 1], slopes[(i + 1) % count], 0.0]]
            assert table.at(places) == pytest.approx(BPoly.from_derivatives(x[i : i + 2], ends)(places), abs=1e-9)


def test_lines_and_polynomials_of_the_isg_kernel_alternate_over_the_seam(tmp_path: Path) -> None:
    file = tmp_path / "endless.txt"
    file.write_text(ENDLESS)
    table = read_cycle_table(file, unit="deg")
    assert (table.layout, len(table.places)) == ("ISG and TwinCAT CNC", 7)
    assert (table.stretches[0].start, table.stretches[-1].stop) == (1.5, 361.5)
    lines = [part for part in table.stretches if part.law == "constant velocity"]
    assert [(part.start, part.stop, part.low, part.high) for part in lines] == [
        (1.5, 45.0, 0.0, 340.0), (90.0, 135.0, 240.0, 200.0), (270.0, 340.0, 130.0, 30.0),
    ]  # fmt: skip
    cycle = table.cycle(speed="60 rpm")
    slopes = {1.5: 340 / 43.5, 45.0: 340 / 43.5, 90.0: -40 / 45, 135.0: -40 / 45, 270.0: -10 / 7, 340.0: -10 / 7}
    for place, slope in slopes.items():
        for side in (-1e-9, 1e-9):  # beside the joint
            assert cycle.at_angle(np.array([(place - 1.5 + side) % 360.0]), 1)[0] == pytest.approx(2 * np.pi * slope)
            assert abs(cycle.at_angle(np.array([(place - 1.5 + side) % 360.0]), 2)[0]) < 1e-3
    file.write_text(ENDLESS.replace("3400000 300000 # MasterPos[5] SlavePos[5]\n", "").replace("= 6", "= 5"))
    with pytest.raises(InputError, match="alternate over an even number of points, and the table has 5"):
        read_cycle_table(file)
    file.write_text(SMALLEST)
    table = read_cycle_table(file, unit="deg")
    assert len(table.places) == 3
    assert (table.stretches[-1].law, table.stretches[-1].start) == ("constant velocity", 150.0)


def test_a_polynomial_beside_a_line_takes_its_slope(tmp_path: Path) -> None:
    """Points of MC3 whose velocities are left to the controller, and of RTmotion without any."""
    rows = [("Polynomial5", 0, 0), ("Linear", 90, 30), ("Polynomial5", 180, 60), ("Linear", 270, 0), ("Linear", 360, 0)]
    point = "(FunctionType := E_Type#{}, MasterPosition := {}, SlavePosition := {}, SlaveVelocity := #Ignore, "
    point += "SlaveAcceleration := #Ignore, SlaveJerk := #Ignore)"
    mc3 = "cam : ARRAY[0..4] OF MotionFunctionPoint := [\n" + ",\n".join(point.format(*row) for row in rows) + "];"
    row = "{{ {1}, {2}, NAN, NAN, {0} }}"
    rtmotion = "static McCamXYVA cam_table[5] = {\n" + ",\n".join(row.format(*each) for each in rows) + "};"
    for text, unknown in (
        (mc3, "#Ignore"),
        (rtmotion.replace("Polynomial5", "polyFive").replace("Linear", "line"), "NAN"),
    ):
        file = tmp_path / "cam.st"
        file.write_text(text)
        with pytest.raises(InputError, match=r"cam\.st: line 2: [Pp]oly.* needs the position and 2 derivatives"):
            read_cycle_table(file)
        file.write_text(text.replace(unknown, "0.0", 3 if unknown == "#Ignore" else 2))
        stretches = read_cycle_table(file).stretches
        assert [part.kind for part in stretches] == ["rise", "rise", "rise", "return", "dwell"]
        assert [stretches[i].stop for i in (0, 1, 3, 4)] == [90.0, 180.0, 270.0, 360.0]
        first, third, last = (stretches[i].law for i in (0, 2, 3))
        assert isinstance(first, MotionLaw)
        assert isinstance(third, MotionLaw)
        assert isinstance(last, MotionLaw)
        assert [first.b(0.0), first.b(1.0), last.b(1.0), first.c(1.0)] == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=1e-9)
        assert third.b(0.0) * stretches[2].stroke / (stretches[2].stop - 180.0) == pytest.approx(1.0 / 3.0)


def test_the_law_of_a_controller_is_that_which_runs(tmp_path: Path) -> None:
    file = tmp_path / "rise.st"
    file.write_text("(MasterPos := 0.0, SlavePos := 5.0, SlaveVelo := 0.0, SlaveAcc := 0.0, SlaveJerk := 0.0, "
                    "FunctionType := 15),\n(MasterPos := 90.0, SlavePos := 25.0, SlaveVelo := 0.0, SlaveAcc := 0.0, "
                    "SlaveJerk := 0.0, FunctionType := 15)")  # fmt: skip
    law = read_law(file)
    k = np.linspace(0.0, 1.0, 11)
    assert law(k) == pytest.approx(QUINTIC(k), abs=1e-14)
    assert law.constants.C.value == pytest.approx(catalogue["3-4-5 polynomial"].law.constants.C.value)
    file.write_text(file.read_text().replace("25.0", "5.0"))
    with pytest.raises(InputError, match=r"rise\.st: it ends where it begins, .* read_cycle_table"):
        read_law(file)


def test_jumps_of_acceleration_between_functions_leave_the_jerk_without_bound(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Three cubics up, whose accelerations differ where they meet, and one down."""
    file = tmp_path / "cubics.csv"
    file.write_text("x deg;y mm;v\n0;0;0\n60;4;0.2\n120;20;0.25\n180;30;0\n360;0;0\n")
    table = read_cycle_table(file, columns=(1, 2, 3))
    rise, back = table.moves
    assert (rise.stop, back.law) == (180.0, "cubic")
    assert "jerk without bound" in str(table)
    ends = ([0.0, 0.0], [4.0, 0.2], [20.0, 0.25], [30.0, 0.0], [0.0, 0.0])
    curve = BPoly.from_derivatives([0.0, 60.0, 120.0, 180.0, 360.0], ends)
    x = np.linspace(0.0, 360.0, 721)
    assert table.at(x) == pytest.approx(curve(x), abs=1e-12)
    both_sides = np.abs(curve.derivative(2)(np.concatenate([x, x[1:] - 1e-9])))
    assert list(table.peaks[1]) == pytest.approx([both_sides.max()] * 2)
    assert exit_code(["cycle", str(file), "--columns", "1,2,3", "--json"]) == 0
    assert '{"low": null, "high": null}' in capsys.readouterr().out


def test_constants_and_lines_of_a_program_are_dwells_and_constant_velocities(tmp_path: Path) -> None:
    rows = "{{0.0, 0.1}, {9.0, 0.0}, {9.0, -0.05}}"
    program = f"double breaks[4] = {{0.0, 90.0, 180.0, 360.0}};\ndouble coefficients[3][2] = {rows};\n"
    (tmp_path / "lines.h").write_text(program)
    table = read_cycle_table(tmp_path / "lines.h")
    assert [(part.kind, part.stop, part.law) for part in table.stretches] == [
        ("rise", 90.0, "constant velocity"), ("dwell", 180.0, None), ("return", 360.0, "constant velocity"),
    ]  # fmt: skip
    for wrong, says in (
        ("{9.0, 0.0}, ", "stated as 6 numbers and are 4"),
        ("9.0, -0.05", "stated as 6 numbers and are 4"),
    ):
        (tmp_path / "wrong.h").write_text(program.replace(wrong, ""))
        with pytest.raises(InputError, match=rf"wrong\.h: line 2: coefficients are {says}: mend them"):
            read_cycle_table(tmp_path / "wrong.h")
    (tmp_path / "steps.h").write_text("double breaks[] = {0.0, 90.0, 180.0};\ndouble coefficients[] = {0.0, 9.0};\n")
    with pytest.raises(
        InputError, match=r"steps\.h: line 1: a piece ends at 90 with the position 0 and the next begins"
    ):
        read_cycle_table(tmp_path / "steps.h")
    (tmp_path / "one.h").write_text("double breaks[] = {0.0, 90.0, 180.0};\ndouble coefficients[] = {9.0, 9.0};\n")
    with pytest.raises(InputError, match=r"one\.h: the table never moves"):
        read_cycle_table(tmp_path / "one.h")


@pytest.mark.parametrize("seed", [*range(12), *(pytest.param(seed, marks=pytest.mark.long) for seed in range(12, 200))])
def test_any_functions_are_the_moves_of_their_table(seed: int) -> None:
    """Polynomials through points with velocities and accelerations, some at rest, and rests between them."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 12))
    x = np.concatenate([[0.0], np.sort(rng.uniform(10.0, 350.0, count - 1)), [360.0]])
    values = rng.normal(size=(count, 3)) * [10.0, 0.3, 0.01] * rng.integers(0, 2, size=(count, 1)) ** [0, 1, 1]
    values[1::3] = values[0::3][: len(values[1::3])] * [1.0, 0.0, 0.0]
    values[0::3] *= [1.0, 0.0, 0.0]
    values[-1, 0] += 5.0
    values = np.vstack([values, values[0]])
    pieces = [hermite(x[i], x[i + 1], values[i], values[i + 1]) for i in range(count)]
    stretches = stretches_of_pieces(pieces)
    assert stretches[0].start == 0.0
    assert [part.stop for part in stretches[:-1]] == [part.start for part in stretches[1:]]
    assert [part.high for part in stretches[:-1]] == [part.low for part in stretches[1:]]
    u, size = np.linspace(0.0, 1.0, 201), np.ptp(values[:, 0])
    for piece in pieces:
        places, heights = piece.start + piece.length * u, piece.at(u)
        read = np.array([position(next(part for part in stretches if place <= part.stop), place) for place in places])
        assert np.abs(read - heights).max() <= 2e-6 * max(size, np.ptp(heights))
    for nu in (1, 2):
        greatest = max(np.abs(piece.at(u, nu)).max() for piece in pieces)
        assert max(part.peaks[nu - 1].high for part in stretches if part.peaks) == pytest.approx(greatest, rel=2e-3)
    for part in stretches:
        displacement = law_of_move(part)(u) if part.law is not None else u
        # what turns by no more than REAL32 may leave is no move of its own
        turned = abs(part.stroke) * (np.maximum.accumulate(displacement) - displacement).max()
        assert turned <= 1.2e-7 * max(sum(map(abs, piece.values)) for piece in pieces)
