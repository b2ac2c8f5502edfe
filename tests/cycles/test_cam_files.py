"""Files of controllers read back: every format that is written, in every unit; layouts of others; damaged files."""

import re
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from optlaws import InputError, catalogue, read_cycle_table
from tests.exports.samples import GOLDEN, press
from tests.internals.cycles import points_in, read_points
from tests.internals.exports import FORMATS, Export

#: what has no place for units
BARE = ("kas", "sew", "technosoft")
#: the law each time of formats that differ by rounding, time or polynomials; others hold the same points
SPLIT = {
    "br-acp10": "optimal",
    "codesys-xy": "modified sine",
    "iec-st-real": "optimal",
    "isg": "modified sine",
    "ros2": "optimal",
    "siemens-elements": "modified sine",
    "technosoft": "optimal",
    "twincat-mc3": "modified sine",
}
UNITS = [("360 deg", "mm"), ("6.283185307179586 rad", "in"), ("1 turn", "m"), (None, "mm")]


@cache
def exported(name: str, master: str | None = "360 deg", unit: str = "mm", **options: Any) -> Export:
    if "points" in FORMATS[name].takes and "polynomials" not in FORMATS[name].model:
        options["points"] = 41
    made: Export = press().export(name, master=master, unit=unit, **options)
    return made


def units_of(made: Export) -> dict[str, str]:
    """What has to be said of a file that does not say it."""
    units = made.motion.units
    if made.format.name == "technosoft":
        step = made.motion.length / (128 * (made.points - 1))
        return {"unit": f"{made.motion.stroke / 65536!r} {units.slave}", "master": f"{step!r} {units.master}"}
    return {"unit": units.slave, "master": units.master} if made.format.name in BARE else {}


def compared(made: Export, file: Path) -> None:
    """The places and positions of a file are those that its export says the controller runs."""
    file.write_text(made.text, "utf-8")
    read = read_points(file, **units_of(made))
    name, units = made.format.name, made.motion.units
    x, y = read.places, read.heights
    if name == "ros2":
        x, y = x * (units.rate or 1.0), y * {"mm": 1e3, "in": 1.0 / 0.0254, "m": 1.0}[units.slave]
        assert (read.units.master, read.units.slave) == ("s", "m")
    elif name == "isg":
        assert (read.units.master, read.units.slave) == ("deg", "mm")
        x, y = x * made.motion.stop / 360.0, y / {"mm": 1.0, "in": 25.4, "m": 1e3}[units.slave]
    else:
        assert (read.units.master, read.units.slave) == (units.master, units.slave)
    assert read.rate is None or read.rate == pytest.approx(units.rate, rel=1e-8)
    assert x[[0, -1]] == pytest.approx(made.motion.breaks[:: len(made.motion.breaks) - 1], rel=1e-7, abs=1e-7)
    close = {"rockwell-cam": 3e-7, "iec-st-real": 1e-6, "br-acp10": 1e-6}.get(name, 1e-9)
    run = made.run(np.clip(x, made.run.start, made.run.stop))
    assert np.abs(y - run).max() <= close * made.motion.stroke + read.digit


@pytest.mark.sample(8)
@pytest.mark.parametrize("units", UNITS, ids=lambda units: f"{units[0]}-{units[1]}")
@pytest.mark.parametrize("name", sorted(FORMATS))
def test_every_format_is_read_back(name: str, units: tuple[str | None, str], tmp_path: Path) -> None:
    try:
        made = exported(name, *units)
    except InputError as error:
        assert name in {"br-acp10", "isg"}, str(error)  # noqa: PT017 - of whole periods, or an angle
        return
    compared(made, tmp_path / f"cam{FORMATS[name].extension}")


@pytest.mark.parametrize("name", ["csv", "kas", "lenze", "sew"])
def test_decimal_commas_are_read(name: str, tmp_path: Path) -> None:
    compared(exported(name, decimal=","), tmp_path / "cam.txt")


@pytest.mark.parametrize("interpolation", ["c1", "quintic", "septic"])
def test_derivatives_in_columns_are_what_runs_between_points(interpolation: Any, tmp_path: Path) -> None:
    made = press().export("csv", points=25, interpolation=interpolation)
    compared(made, tmp_path / "cam.csv")
    heading, *rows = made.text.splitlines()[1:]
    # by the second, in a file of nobody
    rate = [1200.0**nu for nu in range(3)]
    cells = [[float(cell) for cell in row.split(",")] for row in rows]
    lines = [";".join(repr(value * r) for value, r in zip(row[1:], rate, strict=False)) for row in cells]
    body = "\n".join(f"{row[0]!r};{line}" for row, line in zip(cells, lines, strict=True))
    (tmp_path / "other.txt").write_text(f"angle [deg];lift [mm];v;a;j\n{body}\n")
    columns = (1, 2, "v", "a")[: min(4, len(cells[0]))]
    read = read_points(tmp_path / "other.txt", columns)
    assert (read.units.master, read.units.slave) == ("deg", "mm")
    assert len(heading) > 0
    off = np.abs(read.heights - np.asarray(made.motion(read.places))).max()
    assert off < {"c1": 0.05, "quintic": 5e-3, "septic": 5e-3}[interpolation]


@pytest.mark.parametrize(
    ("name", "law"),
    [
        pytest.param(name, law, marks=[] if SPLIT.get(name) == law else [pytest.mark.long])
        for name, law in product(sorted(FORMATS), ["optimal", "modified sine"])
    ],
)
def test_every_format_comes_back_as_the_cycle_it_was(name: str, law: str, tmp_path: Path) -> None:
    """Its dwells and moves, their ends and laws; the acceleration within its interval or what the controller runs."""
    cycle = press(law)
    made: Export = cycle.export(name, master="360 deg", unit="mm")
    file = tmp_path / f"cam{FORMATS[name].extension}"
    file.write_text(made.text, "utf-8")
    units: dict[str, Any] = {**units_of(made)}
    table = read_cycle_table(file, **units)
    per, size = (1.0 / 1200.0, 1e3) if table.master == "s" else (1.0, 1.0)
    assert [part.kind for part in table.stretches] == ["rise", "dwell", "return", "dwell"]
    close = {"isg": 0.02, "technosoft": 0.02}.get(name, 1e-4)
    assert [part.stop / per for part in table.stretches] == pytest.approx([120.0, 210.0, 310.0, 360.0], abs=close)
    assert [size * part.stroke for part in table.moves] == pytest.approx([35.0, -35.0], abs=size * table.room + 1e-5)
    if law == "modified sine":
        assert [part.law for part in table.moves] == [law] * 2
    read, x = table.cycle(speed=None if table.rate or table.master == "s" else "200 rpm"), np.linspace(0.0, 360.0, 721)
    assert np.abs(read.at_angle(x) - cycle.at_angle(x)).max() <= 35e-7 + 1e-3 * size * table.room
    peak, (low, high) = cycle.peak(2) * 1e3 / size / (1200.0 * per) ** 2, table.peaks[1]
    # counts of places and of positions tell less of the acceleration
    wide = 1.025 if name == "technosoft" else 1.02
    assert (1.0 - 1e-4) * low <= peak <= (1.0 + 1e-4) * high < wide * peak


@pytest.mark.parametrize(("size", "length"), [(1e-12, 1e9), (1e9, 1e-9)])
def test_a_cycle_survives_units_of_any_size(size: float, length: float, tmp_path: Path) -> None:
    x = np.linspace(0.0, 1.0, 61)
    law = catalogue["cycloidal"].law
    y = law(np.clip(3.0 * x, 0.0, 1.0)) - law(np.clip(3.0 * x - 1.5, 0.0, 1.0))
    rows = "\n".join(f"{a!r} {b!r}" for a, b in zip((length * x).tolist(), (size * y).tolist(), strict=True))
    (tmp_path / "cam.txt").write_text(rows)
    table = read_cycle_table(tmp_path / "cam.txt", master=f"{360.0 / length!r} deg")
    assert [part.law for part in table.moves] == ["cycloidal", "cycloidal"]
    assert table.moves[0].stroke == pytest.approx(size)
    assert table.cycle(speed="60 rpm").peak(1) > 0.0


#: the layouts of others, with what is read of them: points (0, 0) (120, 35) (240, 35) (360, 0), at rest
OTHERS = {
    "PLCopen XML": """<?xml version="1.0" encoding="utf-8"?>
<project xmlns="http://www.plcopen.org/xml/tc6_0200"><variable name="cam"><initialValue><arrayValue>
{points}</arrayValue></initialValue></variable></project>""",
    "TwinCAT declaration": """<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject><GVL Name="Cams"><Declaration><![CDATA[VAR_GLOBAL cam : ARRAY[1..4] OF MC_MotionFunctionPoint := [
{points}]; END_VAR]]></Declaration></GVL></TcPlcObject>""",
    "L5X": """<?xml version="1.0" encoding="UTF-8"?>
<RSLogix5000Content><Tags><Tag Name="Old" DataType="CAM" Dimensions="4">
<Data Format="Decorated"><Array DataType="CAM" Dimensions="4">{points}</Array></Data></Tag>
</Tags></RSLogix5000Content>""",
}
POINTS = [(0.0, 0.0), (120.0, 35.0), (240.0, 35.0), (360.0, 0.0)]
ROWS = {
    "PLCopen XML": '<value><structValue><value member="dX"><simpleValue value="{x}"/></value><value member="dY">'
    '<simpleValue value="{y}"/></value><value member="dV"><simpleValue value="0"/></value><value member="dA">'
    '<simpleValue value="0"/></value></structValue></value>\n',
    "TwinCAT declaration": "(PointIndex := {n}, FunctionType := {kind}, PointType := 1, RelIndexNextPoint := 1, "
    "MasterPos := {x}, SlavePos := {y}, SlaveVelo := 0.0, SlaveAcc := 0.0, SlaveJerk := 0.0)\n",
}


@pytest.mark.parametrize(
    ("kind", "law"),
    [
        ("MOTIONFUNCTYPE_POLYNOM5", "3-4-5 polynomial"),
        ("MOTIONFUNCTYPE_MODSINUSLINIE", "modified sine"),
        ("MC_MotionFunctionType.MOTIONFUNCTYPE_POLYNOM5_MM", "3-4-5 polynomial"),
        pytest.param("15", "3-4-5 polynomial", marks=pytest.mark.long),
        pytest.param("10", "simple harmonic", marks=pytest.mark.long),
        pytest.param("MOTIONFUNCTYPE_BESTEHORN", "cycloidal", marks=pytest.mark.long),
        pytest.param("MOTIONFUNCTYPE_POLYNOM7_MM", "4-5-6-7 polynomial", marks=pytest.mark.long),
    ],
)
def test_profiles_of_twincat_are_laws_of_the_catalogue(kind: str, law: str, tmp_path: Path) -> None:
    row = ROWS["TwinCAT declaration"]
    rows = "".join(row.format(n=i + 1, kind=kind, x=x, y=y) for i, (x, y) in enumerate(POINTS))
    file = tmp_path / "Cams.TcGVL"
    file.write_text(OTHERS["TwinCAT declaration"].format(points=rows))
    table = read_cycle_table(file)
    assert [part.law for part in table.stretches] == [law, None, law]
    assert [part.stop for part in table.stretches] == pytest.approx([120.0, 240.0, 360.0])
    file.write_text(file.read_text().replace(kind, "MOTIONFUNCTYPE_TOOTHPASTE"))
    with pytest.raises(InputError, match=r"line \d+: there is no profile 'TOOTHPASTE'"):
        read_cycle_table(file)


def test_the_schema_of_plcopen_is_read(tmp_path: Path) -> None:
    rows = "".join(ROWS["PLCopen XML"].format(x=x, y=y) for x, y in POINTS)
    file = tmp_path / "cam.xml"
    file.write_text(OTHERS["PLCopen XML"].format(points=rows))
    assert [part.law for part in read_cycle_table(file).moves] == ["3-4-5 polynomial"] * 2
    file.write_text(OTHERS["PLCopen XML"].format(points=rows)[:-30])
    with pytest.raises(InputError, match=r"cam.xml: it is no XML that can be read: .*line"):
        read_cycle_table(file)


@pytest.mark.parametrize("layout", ROWS)
def test_errors_in_xml_name_the_line_of_the_file(layout: str, tmp_path: Path) -> None:
    rows = [ROWS[layout].format(n=i + 1, kind="POLYNOM5", x=x, y=y) for i, (x, y) in enumerate(POINTS)]
    text = OTHERS[layout].format(points="".join([*rows[:2], rows[2].replace("240.0", "24o.0"), *rows[3:]]))
    wrong = next(i for i, line in enumerate(text.splitlines(), 1) if "24o.0" in line)
    file = tmp_path / "cam.xml"
    file.write_text(text)
    with pytest.raises(InputError, match=rf"cam\.xml: line {wrong}: '24o.0' is no number"):
        read_cycle_table(file)


UNUSED = ",[0,0,0,0,0,0,0,0,0,0,0,0,0,0]"


def l5x(*tags: str) -> str:
    return f'<?xml version="1.0"?>\n<RSLogix5000Content><Tags>{"".join(tags)}</Tags></RSLogix5000Content>'


def tag(name: str, kind: str, data: str) -> str:
    return f'<Tag Name="{name}" DataType="{kind}"><Data Format="L5K"><![CDATA[[{data}]]]></Data></Tag>\n'


def test_projects_of_logix_designer(tmp_path: Path) -> None:
    from scipy.interpolate import CubicSpline

    file = tmp_path / "press.L5X"
    spline = CubicSpline([0.0, 40.0, 100.0], [0.0, 20.0, 25.0], bc_type=((1, np.array(1.0)), (1, np.array(0.0))))
    made = exported("rockwell-cam-extended").text
    pairs = re.findall(r"Master := (\S+); \S+Slave := (\S+);", made)
    cam = ",".join(f"[{x},{y},1]" for x, y in pairs)
    for data in (GOLDEN, GOLDEN + 2 * UNUSED):
        file.write_text(l5x(tag("Profile", "CAM_PROFILE", data), '<Tag Name="Speed" DataType="REAL"/>'))
        read = read_points(file)
        assert read.heights == pytest.approx(spline(read.places), abs=1e-13)
    file.write_text(l5x(tag("Profile", "CAM_PROFILE", GOLDEN), tag("Press", "CAM", cam)))
    with pytest.raises(InputError, match="several cams, say which: Profile, Press"):
        read_points(file)
    with pytest.raises(InputError, match="no cam 'Pres'; it has"):
        read_points(file, cam="Pres")
    assert [part.law for part in read_cycle_table(file, cam="Press").moves] == ["modified sine"] * 2
    decorated = "".join(
        f'<Element Index="[{i}]"><Structure DataType="CAM"><DataValueMember Name="Master" Value="{x}"/>'
        f'<DataValueMember Name="Slave" Value="{y}"/><DataValueMember Name="SegmentType" Value="1"/></Structure>'
        "</Element>"
        for i, (x, y) in enumerate(pairs)
    )
    file.write_text(OTHERS["L5X"].format(points=decorated))
    assert read_points(file).heights.tolist() == read_points(_packed(tmp_path, cam)).heights.tolist()
    file.write_text(l5x(tag("Empty", "CAM_PROFILE", UNUSED[1:])))
    with pytest.raises(InputError, match=r"press\.L5X"):
        read_cycle_table(file)


def _packed(folder: Path, cam: str) -> Path:
    file = folder / "packed.L5X"
    file.write_text(l5x(tag("Press", "CAM", cam)))
    return file


def test_tables_of_other_run_times(tmp_path: Path) -> None:
    law = catalogue["cycloidal"].law
    x = np.linspace(0.0, 1.0, 61)
    y = law(np.clip(2.5 * x, 0.0, 1.0)) - law(np.clip(2.5 * x - 1.25, 0.0, 1.0))
    rows = ",\n".join(f"{{ {a!r}, {b!r}, NAN, NAN, polyFive }}" for a, b in zip(x.tolist(), y.tolist(), strict=True))
    file = tmp_path / "cam.cpp"
    file.write_text(f"// a demo\nstatic McCamXYVA cam_table[61] = {{ {rows} }};\nint main() {{ return 0; }}\n")
    table = read_cycle_table(file)
    assert (table.layout, table.master) == ("RTmotion McCamXYVA without a unit, taken as mm", "turn")
    assert [part.law for part in table.moves] == ["cycloidal", "cycloidal"]
    assert table.cycle(speed="60 rpm").duration == pytest.approx(1.0)


def test_comments_behind_the_keywords_of_isg(tmp_path: Path) -> None:
    """As the manual of the ISG kernel prints its cam tables: a comment behind every line."""
    law, k = catalogue["cycloidal"].law, np.linspace(0.0, 1.0, 25)
    rows = "\n".join(f"{round(1.2e6 * x)} {round(35e4 * float(law(x)))}  # point" for x in k)
    head = "Tablename = Rise # name\nTabletype = 7 # type\nFunction type = 1 # kind\n{} # count\nBegintable # begin\n"
    file = tmp_path / "rise.txt"
    file.write_text(f"{head.format('Lines = 25')}{rows}\nEndTable # end of table\n")
    (rise,) = read_cycle_table(file).stretches
    assert (rise.law, rise.start, rise.stop, rise.stroke) == ("cycloidal", 0.0, 120.0, 35.0)
    file.write_text(f"{head.format('Lines = 24')}{rows}\nEndTable # end of table\n")
    with pytest.raises(InputError, match="states 24 points and contains 25"):
        read_cycle_table(file)
    file.write_text(f"{head.format('Lines = 25')}{rows}\n")
    with pytest.raises(InputError, match="no EndTable"):
        read_cycle_table(file)


def lines_of(name: str) -> list[str]:
    return exported(name).text.splitlines()


@pytest.mark.sample(10)
@pytest.mark.parametrize("name", sorted(FORMATS))
def test_a_file_with_a_line_missing_or_wrong_is_refused_or_says_the_same(name: str, tmp_path: Path) -> None:
    """A line removed, doubled, emptied of its numbers, or the end cut: an error with the file, or the same moves."""
    made, lines, file = exported(name), lines_of(name), tmp_path / f"cam{FORMATS[name].extension}"
    units, whole = units_of(made), lines_of(name)
    size = made.motion.stroke * {"ros2": 1e-3}.get(name, 1.0)
    step = max(1, len(lines) // 12)
    refused = same = 0
    for i in [*range(0, len(lines), step), len(lines) - 1]:
        for damaged in (
            [*whole[:i], *whole[i + 1 :]],
            [*whole[:i], re.sub(r"\d+\.\d+|\d{2,}", "what", whole[i]), *whole[i + 1 :]],
            [*whole[: i + 1], *whole[i:]],
            whole[:i],
        ):
            file.write_text("\n".join(damaged))
            try:
                read = read_points(file, **units)
            except InputError as error:
                assert str(file) in str(error)  # noqa: PT017
                assert re.search(r"lines? \d|holds no points|say which|no joint", str(error))  # noqa: PT017 - of each
                refused += 1
                continue
            if len(read.places) < 12:
                continue  # refused by what divides it
            if name in {"isg", "technosoft", "ros2"} or read.units.slave != made.motion.units.slave:
                same += 1
                continue
            expected = made.run(np.clip(read.places, made.run.start, made.run.stop))
            assert np.abs(read.heights - expected).max() <= 2e-2 * size
            same += 1
    assert refused > 0
    assert same > 0


def test_what_is_no_table_is_said_to_be_none(tmp_path: Path) -> None:
    for text, says in (
        ("hello", "holds no points"),
        ("", "holds no points"),
        ("<a><b/></a>", "holds no points"),
        ("<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>", "entities of its own"),
        ("x : ARRAY[0..2] OF LREAL := [1.0, 2.0", "line 1: an array does not end"),
        ("5\n0;0\n1;1\n2;1\n", "states 5 points and contains 3"),
        ("CYCLIC;YES;\nTABLE_BEGIN;;\n0;0;SPLINE\n1;1;SPLINE\n", "no TABLE_END"),
    ):
        (tmp_path / "cam.txt").write_text(text)
        with pytest.raises(InputError, match=says):
            read_cycle_table(tmp_path / "cam.txt")


@pytest.mark.long
def test_what_is_gained_is_recomputed_from_the_laws(tmp_path: Path) -> None:
    file = tmp_path / "cam.csv"
    file.write_text(exported("csv").text)
    old = read_cycle_table(file)
    new = old.bettered(0.05, degree=9)
    before, after = old.cycle(speed="200 rpm"), new.cycle(speed="200 rpm")
    degrees = np.linspace(0.0, 360.0, 20001)
    for gain, part in zip(new.gains(old), old.moves, strict=True):
        inside = degrees[(degrees > part.start) & (degrees < part.stop)]
        for nu in (1, 2):
            sizes = [np.abs(np.asarray(cycle.per_angle(inside, nu))).max() * 1e3 for cycle in (before, after)]
            by_degree = (np.pi / 180.0) ** nu
            assert [gain.old[nu - 1], gain.new[nu - 1]] == pytest.approx([s * by_degree for s in sizes], rel=1e-4)
        off = 1e3 * np.abs(np.asarray(after.at_angle(inside)) - np.asarray(before.at_angle(inside))).max()
        assert gain.deviation == pytest.approx(off, rel=1e-3)
        assert gain.deviation <= 0.05 * (1.0 + 1e-6)
        assert -0.15 < gain.share(2) < -0.05
    with pytest.raises(InputError, match="tolerance must be above 0"):
        old.bettered(0.0)


def test_a_law_stays_where_none_within_the_tolerance_is_better(tmp_path: Path) -> None:
    (tmp_path / "cam.csv").write_text(exported("csv").text)
    old = read_cycle_table(tmp_path / "cam.csv")
    assert [part.law for part in old.bettered(1e-7, degree=5).moves] == ["modified sine"] * 2


TOKENS = [
    *"[](){};,|#<>\n\t\0xe+.=",
    ":=",
    "//",
    "(*",
    "*)",
    "",
    "0",
    "-1",
    "nan",
    "inf",
    "1e999",
    "9" * 40,
    "1_0",
    "16#F",
]
COUNTS = [12, pytest.param(400, marks=pytest.mark.long)]


@pytest.mark.sample(10)
@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("name", sorted(FORMATS))
def test_whatever_a_file_holds_it_is_read_or_refused(name: str, count: int) -> None:
    """Words of a file that are left out, doubled, exchanged or replaced by what a file may hold anywhere."""
    rng, text = np.random.default_rng(count), exported(name).text
    for _ in range(count):
        damaged = text
        for _ in range(rng.integers(1, 4)):
            words = [match.span() for match in re.finditer(r"[\w.+-]+|\S", damaged)]
            (start, stop), (low, high) = (words[i] for i in rng.integers(len(words), size=2))
            word, other, token = damaged[start:stop], damaged[low:high], TOKENS[rng.integers(len(TOKENS))]
            damaged = damaged[:start] + ["", 2 * word, other, token][rng.integers(4)] + damaged[stop:]
        try:
            read = points_in(damaged, Path(name), unit="mm")
        except InputError as error:
            assert name in str(error)  # noqa: PT017 - of each
            continue
        assert np.all(np.isfinite(read.places))
        assert np.all(np.isfinite(read.heights))
