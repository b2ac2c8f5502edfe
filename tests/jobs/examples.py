"""A small problem file for every job, the data that it names, and what is wrong with it when it is changed."""

from dataclasses import dataclass, field

from tests.documents import ROOT

ATLAS = """
job = "atlas"
title = "A small atlas"
[problem]
basis = "chebyshev"
[vary]
minimise = ["C", "D"]
order = [3, 4]
degree = [5, 7]
B = [1.5, 1.8]
"""
CYCLE = """
job = "cycle"
title = "Slide"
speed = "200 rpm"
rows = 13
[[axis]]
name = "slide"
limits = { velocity = "616 mm/s" }
drive = { mass = "2 kg", dry = "5 N" }
[[axis.export]]
to = "rockwell-cam"
points = 61
counts = 65536
[[axis.segment]]
kind = "rise"
by = "35 mm"
duration = "120 deg"
[[axis.segment]]
kind = "dwell"
duration = "90 deg"
[[axis.segment]]
kind = "return"
duration = "100 deg"
[[axis.segment]]
kind = "dwell"
"""
CAM = """
job = "cam"
title = "Slide on a cam"
speed = "200 rpm"
rows = 13
base_radius = "50 mm"
cutter_radius = "20 mm"
pressure_angle = "30 deg"
[follower]
kind = "translating roller"
radius = "12 mm"
offset = "6 mm"
[forces]
width = "20 mm"
[spring]
speeds = ["0 rpm", "300 rpm"]
preload = "60 N"
[as_made]
points = [121]
decimals = [3]
[[file]]
name = "profile.nc"
cutter_radius = "10 mm"
decimals = 3
tolerance = "20 um"
[motion]
name = "slide"
drive = { mass = "2 kg", stiffness = "2 N/mm", preload = "60 N" }
[[motion.segment]]
kind = "rise"
by = "20 mm"
duration = "120 deg"
law = "cycloidal"
[[motion.segment]]
kind = "return"
law = "cycloidal"
"""
DWELL_TYPES = """
job = "dwell types"
title = "Few"
law = "K"
radius_over_length = 0.35
inertia_ratio = 0.1
swings = [20]
clutch_angles = [15]
dwells = [30, 90]
teeth = 120
[map]
limits = [5]
clutch_angles = [5, 15]
[[scenario]]
name = "half a turn"
"""
DWELL_DRAWING = """
job = "dwell drawing"
title = "Three"
law = "cycloidal"
rise = 80
dwell = 100
clutch_angle = 12
swing = 25
radius_ratio = 1.2
inertia_ratio = 0.15
"""
FOLLOWER = """
job = "follower"
title = "Small"
nu = 15
deviations = [-5, 0]
[[cam]]
name = "first"
law = "III"
alpha = 7.2
design_damping = 0.1
[[cam]]
name = "second"
law = "cycloidal"
[[off_design]]
cam = "first"
damping = 0.1
[[off_design]]
cam = "second"
damping = 0.1
change = "stiffness"
[spectrum]
cams = ["first", "second"]
damping = 0.1
from = 5
to = 30
points = 20
[curves]
cams = ["first"]
damping = 0.1
deviations = [-5]
"""
FRONTS = """
job = "fronts"
title = "Small"
points = 4
[problem]
order = 4
degree = 3
[[figure]]
name = "one"
title = "C at given B"
over = ["B", "C"]
between = [1.4, 1.9]
catalogue = ["II", "smoothstep", "modified sine"]
front = [{ label = "l = 4" }, { label = "l = 3", order = 3, points = 3 }]
[[figure]]
name = "two"
title = "J at given C"
over = ["C", "J"]
front = [{ label = "B = 1.641", B = 1.641 }]
"""
LEVER_PRINTED = "coefficient,beta,lambda,printed\nQ,0.5,,0.375\nR,1,3,0.000\nR,1.5,10,0.172\nP,0.25,,0.234\n"
LEDGER = """
job = "ledger"
title = "Two items"
papers = ["paper.toml"]
"""
LEDGER_PAPER = """
title = "A paper"
source = "none"
[[item]]
id = "C of S3"
kind = "number"
printed = "5.774"
compute = "optimal.smooth_constant"
arguments = { order = 3, name = "C", steps = 20 }
verdict = "reproduced to its digits"
[[item]]
id = "Z of S3"
kind = "formula"
printed = "Z = -3 + 6*k"
compute = "optimal.known_law"
arguments = { order = 3 }
verdict = "agrees"
"""
LEVER_TABLES = """
job = "lever tables"
title = "Few"
printed = "few.csv"
[[misprint]]
coefficient = "P"
beta = "0.25"
reason = "the sign"
"""
LEVER_MOMENTS = """
job = "lever moments"
title = "Two"
[[panel]]
beta = 0.5
swing = 60
[[panel.curve]]
lambda = 1
rho = 0.15
nu = 0.15
[[panel.curve]]
beta = 1
lambda = 2
rho = 0.05
nu = 0.3
"""
OWN_SEARCH = """
job = "own search"
title = "One"
order = 4
B = [1.969]
[[start]]
name = "ones"
z = [1, 1, 1, 1]
"""
LEVER_PARAMETRIC = """
job = "lever parametric"
title = "Few"
beta = [0.5, 1.0, 1.5]
lambda = [1, 4]
rho = [0.15]
nu = [0.05, 0.15]
swing = [30, 100]
drawn = [0.5, 1.5]
"""
LEVER_NOMOGRAM = """
job = "lever nomogram"
title = "Few"
beta = [0.5, 1.5]
lambda = 3
rho = 0.15
nu = 0.15
tabled = [20, 60]
points = 5
"""
LEVER_DRAWING = """
job = "lever drawing"
title = "One"
beta = 0.75
lambda = 1
rho = 0.15
nu = 0.15
swing = 60
"""
LOADER_PRINTED = """# printed
code,law,B,C,D
K,K,1.571,4.94,3.876
0050,0050,1.274,inf,3.248
KC00,KC00,1.632,4.734,4.897
"""
LOADER_TABLE = 'job = "loader table"\ntitle = "Three"\nprinted = "printed.csv"\ngrid = 20\n'
LOADER_NOMOGRAM = (
    'job = "loader nomogram"\ntitle = "Few"\ngamma_w = [0.25, 0.3]\n[e13]\nfrom = 0.6\nto = 0.66\nstep = 0.03\n'
)
LOADER_DRAWING = 'job = "loader drawing"\ntitle = "One"\nlaw = "3-4-5 polynomial"\nshown = 40\nradius_ratio = 1.0\n'
ONE_PRINTED = """# printed
code,law,B,C,D
Shun,3-4-5 polynomial,1.423,5.7,3.841
"""
LOADER_OPTIMAL = (
    'job = "loader optimal"\ntitle = "One"\nprinted = "printed.csv"\norders = [3]\ndegrees = [5]\nshown = "Shun"\n'
)
SOLUTIONS = """
job = "solutions"
title = "Small"
text = "Few words."
columns = ["C", "J", "lower bound", "gap", "limit", "above limit, %", "status"]
[problem]
order = 4
[[sweep]]
B = [1.53, [1.5, 1.8], "free"]
[[sweep]]
degree = [3, 9]
basis = ["powers", "chebyshev"]
[[compare]]
name = "law of least J"
columns = ["C"]
problem = { minimise = "J" }
[beside]
name = "printed"
file = "printed.csv"
match = "B"
columns = ["C"]
"""
MACHINE_LAWS = """
job = "machine laws"
title = "Small"
report = ["torque"]
standard = ["cycloidal"]
[machine]
masses = { motor = 1.0, load = 2.0 }
links = [["motor", "load", 450.0, 1.0]]
drive = "motor"
outputs = { torque = "drive force", sway = "deflection motor-load" }
[units]
torque = "N m"
[vibration]
output = "sway"
[[sought]]
name = "ours"
minimise = { peak = "torque" }
keep = [{ residual = 1, output = "sway", spread = 0.1, most = 0.005 }, { constant = "J", most = 200.0 }]
problem = { order = 3, degree = 7 }
[figure]
output = "torque"
laws = ["cycloidal, ZV", "ours"]
"""
OPTIMAL_POLYDYNE = (
    (ROOT / "problems" / "optimal_polydyne.toml")
    .read_text("utf-8")
    .replace("degree = 15", "degree = 7")
    .replace("dampings = [0.0, 0.05]", "dampings = [0.0]")
)
OPTIMAL_TABLE = """
job = "optimal table"
title = "One"
printed = "printed.csv"
order = 4
monotone = false
degrees = [3, 5]
grid = 100
[bases.S4]
order = 4
[[misprint]]
row = "1.641"
quantity = "C"
printed = 6
reason = "a digit"
[figure]
degrees = [3, 5]
from = 1.6
to = 1.7
points = 3
"""
TABLE_PRINTED = """# printed
B,C,D,base,z,note
1.641,6.2577,5.5124,S4,-33.28 139.84 -139.84,-
"""
SOLUTIONS_PRINTED = "# comment\nB,C\n1.53,7.3617\n"
SAVIN_FAMILIES = 'job = "savin families"\ntitle = "Two"\nfamilies = ["I", "II"]\nrows = 8\npoints = 11\n'
FORCE_LOADED = """
job = "force loaded"
title = "One"
catalogue = ["cycloidal"]
[problem]
order = 3
degree = 5
[[case]]
name = "a spring"
friction = "0.5"
load = "3*a"
[[case]]
name = "a growing inertia"
inertia = "1 + 0.5*a^2"
"""


@dataclass(frozen=True)
class Example:
    """A problem file with the files beside it; the changes that make it wrong: old text, new text, what is said."""

    text: str
    wrong: tuple[tuple[str, str, str], ...]
    beside: dict[str, str] = field(default_factory=dict)
    wrong_beside: tuple[tuple[str, str, str], ...] = ()


_LAST = "P,0.25,,0.234\n"

EXAMPLES = {
    "atlas": Example(
        ATLAS,
        (
            ("order = [3, 4]", "ordre = [3, 4]", "ordre.*order"),
            ("order = [3, 4]\n", "", "an atlas varies minimise, order, degree, B"),
            ("order = [3, 4]", "order = [0]", "order"),
        ),
    ),
    "cam": Example(
        CAM,
        (
            ('"6 mm"', '"66 mm"', "roller: offset 66 mm is beyond the base circle.*base circle larger"),
            ('"12 mm"', '"52 mm"', "roller: its radius 52 mm is not less"),
            ('offset = "6 mm"', 'arm = "6 mm"', "a translating roller takes no arm; it takes radius, offset"),
            ('radius = "12 mm"\n', "", "base_radius|a translating roller needs its radius"),
            ('"translating roller"', '"translating rollr"', "kind"),
            ('by = "20 mm"', 'by = "20 deg"', "drive: unknown key 'mass'"),
            ('"profile.nc"', '"profile.igs"', "says no format"),
            ('"profile.nc"', '"../profile.nc"', "file: name must be that of a file in the folder"),
            ('tolerance = "20 um"', 'tolerance = "20 s"', "tolerance must be a length"),
            ("mass =", "inertia =", "drive: .*inertia"),
            ('width = "20 mm"', 'width = "0 mm"', "width must be above 0"),
            ("decimals = [3]", "decimal = [3]", "decimal.*decimals"),
            ('"50 mm"', '"50"', "base_radius must be a length"),
        ),
    ),
    "cycle": Example(
        CYCLE,
        (
            ("200 rpm", "200 mm", "speed must be an angular velocity such as '200 rpm', but '200 mm' is a length"),
            ('"616 mm/s"', '"616 mm"', "axis slide: limits, velocity must be a velocity.*is a length"),
            ("120 deg", "220 deg", "axis slide: the durations sum to 410 deg"),
            ('kind = "return"', 'kind = "retrun"', "kind"),
            ('duration = "90 deg"', 'duration = "90 deg"\nby = "3 mm"', "segment 2: a dwell takes no by"),
            ("mass =", "inertia =", "drive: .*inertia"),
            ('"rockwell-cam"', '"rockwell-came"', "axis slide: export to.*did you mean 'rockwell-cam'"),
            ("counts = 65536", "file = '../cam.st'", "axis slide: export to rockwell-cam: file must be a name without"),
            ("counts = 65536", "file = 'slide.csv'", "axis slide: export.*another file is called slide.csv"),
            ("points = 61", "points = 4", "axis slide: export.*points must be from 5"),
        ),
    ),
    "dwell drawing": Example(
        DWELL_DRAWING,
        (
            ("rise = 80", "rise = 0", "rise"),
            ("clutch_angle = 12", "clutch_angle = 60", "exceed twice clutch_angle"),
        ),
    ),
    "dwell types": Example(
        DWELL_TYPES,
        (
            ("swings", "swing", "swing.*swings"),
            ("dwells = [30, 90]", "dwells = []", "dwells"),
            ("dwells = [30, 90]", "dwells = [30, 190]", "rise must be positive"),
            ('law = "K"', 'law = "Kq"', "no law is called"),
            ("clutch_angles = [5, 15]", "clutch_angles = [5]", "clutch_angles"),
        ),
    ),
    "follower": Example(
        FOLLOWER,
        (
            ("nu = 15", "nu = 0", "nu"),
            ("nu = 15", "mu = 15", "mu.*nu"),
            ('law = "III"', 'law = "II"', "cam first: the mass law has .*velocity of the cam"),
            ("alpha = 7.2", "", "need an alpha"),
            (
                'law = "cycloidal"',
                'law = "cycloidl"',
                "cam second: no law is called 'cycloidl'; did you mean 'cycloidal'",
            ),
            ('name = "second"', 'name = "first"', "names must differ"),
            ('cam = "second"', 'cam = "secnd"', "unknown cam 'secnd'; did you mean 'second'"),
            ('change = "stiffness"', 'change = "mass"', "change"),
            ("deviations = [-5, 0]", "deviations = [-100]", "deviations"),
            ("from = 5", "from = 50", "spectrum"),
            ("damping = 0.1\nfrom = 5", "damping = 1.0\nfrom = 5", "damping"),
        ),
    ),
    "fronts": Example(
        FRONTS,
        (
            ("order = 4", "ordre = 4", "ordre.*order"),
            ('over = ["B", "C"]', 'over = ["B", "K"]', "over"),
            ('over = ["B", "C"]', 'over = ["B"]', "over"),
            ('over = ["B", "C"]', 'over = ["B", "B"]', "figure one, l = 4.*each once"),
            ("between = [1.4, 1.9]", "between = [1.9, 1.4]", "figure one, l = 4.*between"),
            ("between = [1.4, 1.9]", "between = [1.4]", "between"),
            ('{ label = "l = 4" }', '{ lable = "l = 4" }', "lable.*label"),
            ('{ label = "l = 4" }', '{ label = "l = 4", B = 1.6 }', "B is exchanged"),
            ('name = "two"', 'name = "one"', "names must differ"),
            ('name = "two"', 'name = "../two"', "name"),
            ("points = 4", "points = 1", "points"),
            ('["II", "smoothstep", ', '["V", ', "figure one, catalogue: no law is called 'V'"),
        ),
    ),
    "lever drawing": Example(LEVER_DRAWING, (("0.75", "1.5", "the angle between coupler and rocker"),)),
    "lever nomogram": Example(LEVER_NOMOGRAM, (("[20, 60]", "[175]", "no combination of beta and swing"),)),
    "lever parametric": Example(
        LEVER_PARAMETRIC,
        (
            ("drawn = [0.5, 1.5]", "drawn = [0.7]", "drawn: 0.7 not among beta"),
            ("[30, 100]", "[170]", "no combination of beta, lambda, rho, nu and swing"),
            ("[30, 100]", "[200]", "swing"),
            ("lambda", "lamda", "did you mean 'lambda'"),
        ),
    ),
    "ledger": Example(
        LEDGER,
        (
            ("papers", "paper", "did you mean 'papers'"),
            ('["paper.toml"]', "[]", "papers"),
        ),
        {"paper.toml": LEDGER_PAPER},
        (
            ("5.774", "5.775", "verdicts do not hold.*C of S3: declared reproduced to its digits, found to p percent"),
            ("6*k", "7*k", "Z of S3: declared agrees, found contradicted"),
            ("known_law", "know_law", "did you mean 'optimal.known_law'"),
            ('verdict = "agrees"', 'verdict = "confirmed"', "a formula cannot be confirmed"),
        ),
    ),
    "lever moments": Example(
        LEVER_MOMENTS,
        (
            ("lambda = 1", "lamda = 1", "did you mean 'lambda'"),
            ("swing = 60", "swing = 170", "curve 1 of the panel beta = 0.5"),
            ("rho = 0.15", "rho = -0.15", "rho"),
        ),
    ),
    "own search": Example(
        OWN_SEARCH,
        (
            ("1.969", "0.969", "B"),
            ("z = [1, 1, 1, 1]", "z = [1]", "z"),
            ("order = 4", "ordre = 4", "did you mean 'order'"),
        ),
    ),
    "lever tables": Example(
        LEVER_TABLES,
        (
            ('"0.25"', '"0.3"', "misprint: not among the printed numbers .*: P 0.3"),
            ("misprint", "misprit", "did you mean 'misprint'"),
        ),
        {"few.csv": LEVER_PRINTED},
        (
            (_LAST, _LAST + "R,0.5,,0.1\n", "R needs a lambda and the others have none"),
            (_LAST, _LAST + "Q,0.5,1,0.1\n", "R needs a lambda and the others have none"),
            (_LAST, _LAST + "U,0.5,,0.1\n", "coefficient must be Q, P, S or R, got 'U'"),
            (_LAST, _LAST + "Q,-1,,0.1\n", "beta and lambda must be above 0, got -1"),
            (_LAST, _LAST + "Q,0.5,,none\n", "'none' is not a number"),
            (_LAST, _LAST + "Q,0.5,,0.000\n", "printed as 0, it is 0.375"),
        ),
    ),
    "loader drawing": Example(LOADER_DRAWING, (("shown = 40", "shown = 400", "shown"),)),
    "loader nomogram": Example(
        LOADER_NOMOGRAM, (("0.25, 0.3", "0.2", "no trapezium"), ("step = 0.03", "step = 0", "step"))
    ),
    "loader optimal": Example(
        LOADER_OPTIMAL,
        (
            ("Shun", "Shum", "did you mean 'Shun'"),
            ("degrees = [5]", "degrees = [1]", "degrees"),
            ("orders", "order", "did you mean 'orders'"),
        ),
        {"printed.csv": ONE_PRINTED},
    ),
    "loader table": Example(
        LOADER_TABLE,
        (("grid", "gird", "gird.*grid"), ("grid = 20", "grid = 1", "grid")),
        {"printed.csv": LOADER_PRINTED},
        (
            ("1.571", "1,571", "5 cells"),
            ("1.571", "1.5x", "row K, B.*not a number"),
            ("K,K", "K,Kq", "no law is called 'Kq'"),
        ),
    ),
    "machine laws": Example(
        MACHINE_LAWS,
        (
            ("spread = 0.1", "spred = 0.1", "did you mean 'spread'"),
            ('torque = "N m"', 'torqe = "N m"', "units.*did you mean 'torque'"),
            ('report = ["torque"]', 'report = ["torqe"]', "report.*did you mean 'torque'"),
            ('{ peak = "torque" }', '{ peak = "torqe" }', "sought 'ours'.*did you mean 'torque'"),
            ('{ peak = "torque" }', '{ peak = "torque", rms = "torque" }', "one of peak and rms"),
            ("450.0", "-450.0", "machine.*stiffness"),
            ('drive = "motor"', 'drive = "engine"', "machine.*'engine'"),
            ("residual = 1", "residual = 2", "sought 'ours'.*from 1 to 1"),
            ('laws = ["cycloidal, ZV"', 'laws = ["cycloidal, EI"', "no law is called 'cycloidal, EI'"),
            ('["cycloidal"]', '["cycloidial"]', "cycloidial"),
            ("degree = 7", "degre = 7", "did you mean 'degree'"),
        ),
    ),
    "optimal polydyne": Example(
        OPTIMAL_POLYDYNE,
        (
            ("between = [18.0, 22.0]", "between = [22.0, 18.0]", "ascending order"),
            ('family = "IV"', 'family = "II"', "family"),
            ("residual = 0.1", "residuals = 0.1", "residual"),
            ('"4-5-6-7"]', '"4-5-6-8"]', "4-5-6-8"),
        ),
    ),
    "optimal table": Example(
        OPTIMAL_TABLE,
        (
            ("monotone", "monotonous", "did you mean 'monotone'"),
            ('row = "1.641"', 'row = "1.7"', "misprint: row '1.7' is not a B of the printed table"),
            ('quantity = "C"', 'quantity = "z1"', "misprint.*z1"),
            ("printed.csv", "none.csv", "cannot read the printed data"),
        ),
        {"printed.csv": TABLE_PRINTED},
        (
            ("1.641,", "0.641,", "B must be above 1, got 0.641"),
            ("S4", "S5", "base 'S5' is not among the bases S4"),
            ("-33.28 139.84 -139.84", "-33.28", "needs at least 2 coefficients"),
            ("-33.28", "x", "'x' is not a number"),
        ),
    ),
    "savin families": Example(
        SAVIN_FAMILIES,
        (
            ('families = ["I", "II"]', 'families = ["V"]', "families"),
            ('families = ["I", "II"]', "families = [-1]", "families"),
            ("rows = 8", "rows = 0", "rows"),
            ("rows = 8", "row = 8", "did you mean 'rows'"),
        ),
    ),
    "force loaded": Example(
        FORCE_LOADED,
        (
            ('load = "3*a"', 'load = "3*b"', "unknown name 'b'"),
            ('inertia = "1 + 0.5*a^2"', 'inertia = "1 + "', "expected a number"),
            ('name = "a growing inertia"', 'name = "a spring"', "names must differ"),
            ("degree = 5", "degre = 5", "degre.*degree"),
            ('"cycloidal"', '"cycloid of mine"', "cycloid of mine"),
        ),
    ),
    "solutions": Example(
        SOLUTIONS,
        (
            ("order = 4", "ordre = 4", "ordre.*order"),
            ("order = 4", 'order = "4"', "order"),
            ("order = 4", "order = 0", "order"),
            ("order = 4", "", "row 1.*order"),
            ("degree = [3, 9]", "degree = [3, 9, 15]", r"sweep\[1\].*one length"),
            ("degree = [3, 9]", "degree = []", "degree"),
            ("degree = [3, 9]", "B = [1.6, 1.7]", "swept twice"),
            ("[1.5, 1.8]", "[1.5, 1.8, 1.9]", "sweep"),
            ("[1.5, 1.8]", "[1.8, 1.5]", "row 3.*lower bound"),
            ("B = [1.53,", "B = [0.5,", "row 1.*B must"),
            ('columns = ["C", "J",', 'columns = ["C", "Jay",', "Jay"),
            ('minimise = "J"', 'minimise = "Q"', "compare, law of least J, row 1.*Q"),
            ('file = "printed.csv"', 'file = "none.csv"', "none.csv"),
            ('match = "B"\ncolumns = ["C"]', 'match = "B"\ncolumns = ["E"]', "'E'"),
        ),
        {"printed.csv": SOLUTIONS_PRINTED},
    ),
}
