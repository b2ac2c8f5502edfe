"""A small problem file for every job, the data that it names, and what is wrong with it when it is changed."""

from dataclasses import dataclass, field

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
FASTEST = """
job = "fastest"
title = "Quick moves"
[problem]
degree = 7
[[move]]
name = "table"
stroke = "45 deg"
start = "0 deg"
mechanism = { kind = "table", inertia = "0.8 kg m^2" }
drive = { motor = { inertia = "3e-4 kg m^2", peak_torque = "4 N m" }, ratio = 20 }
front = { minimise = ["torque"], points = 2 }
[[move]]
name = "slide"
stroke = ["100 mm", "90 mm"]
limits = { velocity = "1 m/s", acceleration = ["-8 m/s^2", "12 m/s^2"], jerk = "300 m/s^3" }
[[move]]
name = "arm"
stroke = "100 mm"
limits = { jerk = "300 m/s^3" }
follower = { frequency = "16 Hz", damping = 0.02 }
front = { minimise = ["residual acceleration", "jerk"], longest = "0.24 s", points = 3 }
"""
CAM = """
job = "cam"
title = "Slide on a cam"
speed = "200 rpm"
rows = 13
prime_radius = "50 mm"
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
SOLUTIONS = """
job = "solutions"
title = "Small"
text = "Few words."
columns = ["C", "J", "lower bound", "gap", "best possible", "above best possible, %", "status"]
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
SOLUTIONS_PRINTED = "# comment\nB,C\n1.53,7.3617\n"


@dataclass(frozen=True)
class Example:
    """A problem file with the files beside it; the changes that make it wrong: old text, new text, what is said."""

    text: str
    wrong: tuple[tuple[str, str, str], ...]
    beside: dict[str, str] = field(default_factory=dict)
    wrong_beside: tuple[tuple[str, str, str], ...] = ()


EXAMPLES = {
    "cam": Example(
        CAM,
        (
            ('"6 mm"', '"66 mm"', "roller: offset 66 mm is beyond the prime circle.*prime circle larger"),
            ('"12 mm"', '"52 mm"', "roller: its radius 52 mm is not less"),
            ('offset = "6 mm"', 'arm = "6 mm"', "unknown entry of a translating roller 'arm'; known are offset"),
            ('radius = "12 mm"\n', "", "prime_radius|a translating roller needs its radius"),
            ('"translating roller"', '"translating rollr"', "kind"),
            ('by = "20 mm"', 'by = "20 deg"', "drive: unknown key 'mass'"),
            ('"profile.nc"', '"profile.igs"', "names no format"),
            ('"profile.nc"', '"../profile.nc"', "file 1: name must be that of a file in the folder"),
            ('tolerance = "20 um"', 'tolerance = "20 s"', "tolerance must be a length"),
            ("mass =", "inertia =", "drive: .*inertia"),
            ('width = "20 mm"', 'width = "0 mm"', "width must be above 0"),
            ("decimals = [3]", "decimal = [3]", "decimal.*decimals"),
            (
                "[motion]",
                "[motion]\nmechanism = { kind = 'table', inertia = '1 kg' }",
                "a cam's follower has no mechanism",
            ),
            ('"50 mm"', '"50"', "prime_radius must be a length"),
            ("prime_radius =", "base_radius =", "write prime_radius = '50 mm' .* or prime_radius = '62 mm' if"),
            ("prime_radius =", "base_radius = '38 mm'\nprime_radius =", "leave base_radius out"),
            ('prime_radius = "50 mm"', 'turning = "CLOCKWISE"\nbest = "prime circle"', "did you mean 'clockwise'"),
        ),
    ),
    "cycle": Example(
        CYCLE,
        (
            ("200 rpm", "200 mm", "speed must be an angular velocity such as '200 rpm', but '200 mm' is a length"),
            ('"616 mm/s"', '"616 mm"', "axis slide: limits: velocity must be a velocity.*is a length"),
            ('speed = "200 rpm"\n', "", r"(?<=small\.toml): a cycle has either a speed"),
            ("[[axis]]", "[axis]", r"write \[\[axis\]\] in place of \[axis\]"),
            ("120 deg", "220 deg", "axis slide: the durations sum to 410 deg"),
            ('kind = "return"', 'kind = "retrun"', "kind"),
            ('duration = "90 deg"', 'duration = "90 deg"\nby = "3 mm"', "segment 2: unknown entry of a dwell 'by'"),
            ("mass =", "inertia =", "drive: .*inertia"),
            ('"rockwell-cam"', '"rockwell-came"', "axis slide: export to.*did you mean 'rockwell-cam'"),
            ("counts = 65536", "file = '../cam.st'", "axis slide: export to rockwell-cam: file must be a name without"),
            (
                "counts = 65536",
                "file = 'slide.csv'",
                "axis slide: its table: another file is called slide.csv, axis slide: export to rockwell-cam",
            ),
            ("points = 61", "points = 4", "axis slide: export.*points must be from 5"),
        ),
    ),
    "fastest": Example(
        FASTEST,
        (
            ("degree = 7", "degre = 7", "did you mean 'degree'"),
            ("degree = 7", "degree = 7\nB = 1.8", "the problem of a least time leaves B free"),
            (
                "degree = 7",
                'degree = 7\nwindows = [{ quantity = "b", high = 0.9 }]',
                r"(?<!table: )move table: no time is long enough",
            ),
            ('stroke = "45 deg"', 'stroke = "45 mm"', "move table: .*limits|move table: .*angle"),
            ('stroke = "45 deg"', 'strok = "45 deg"', "did you mean 'stroke'"),
            ('name = "slide"', 'name = "Table"', "names must differ as files have them"),
            ('name = "slide"', 'name = "about"', "none is about or fastest"),
            ('["100 mm", "90 mm"]', '["100 mm"]', "stroke"),
            ('velocity = "1 m/s"', 'speed = "1 m/s"', "move slide: limits: unknown limit 'speed'"),
            ('["-8 m/s^2", "12 m/s^2"]', '["8 m/s^2", "12 m/s^2"]', "limits: acceleration: the least must be below 0"),
            (
                '"300 m/s^3" }\n[[move]]',
                '"300 m/s^3" }\nfront = { minimise = ["jerk"] }\n[[move]]',
                "that of one stroke",
            ),
            ('minimise = ["torque"]', 'minimise = ["torqe"]', "move table: front: .*did you mean 'torque'"),
            ('minimise = ["torque"]', 'minimise = ["torque", "torque"]', "move table: front: .*twice"),
            ('minimise = ["torque"]', "minimise = []", "minimise"),
            ("ratio = 20 }", "ration = 20 }", "did you mean 'ratio'"),
            ("drive = {", "drives = {", "did you mean 'drive'"),
            ('mechanism = { kind = "table", inertia = "0.8 kg m^2" }\n', "", "move table: drive: a motor drives"),
            ('["residual acceleration", "jerk"]', '["jerk"]', "move arm: follower: give a limit or a front"),
            ('longest = "0.24 s"', 'longest = "0.2 s"', "move arm: front: longest must be above the least time"),
            ('frequency = "16 Hz"', 'frequency = "16 mm"', "move arm: follower: frequency"),
            ('limits = { jerk = "300 m/s^3" }', "limits = {}", "move arm: limits must name one"),
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
            ('job = "solutions"', 'job = "solution"', "did you mean 'solutions'"),
            ('job = "solutions"', "", "the entry job is missing"),
            ("columns =", "colums =", "did you mean 'columns'"),
            ('match = "B"', 'mach = "B"', "did you mean 'match'"),
            ("degree = [3, 9]", "degree = [0, 9]", "degree"),
            ("[1.5, 1.8]", "[1.5, nan]", "sweep 1: B 2: high must be a finite real number, got nan"),
            ('file = "printed.csv"', 'file = ".."', "cannot read"),
        ),
        {"printed.csv": SOLUTIONS_PRINTED},
        (
            ("B,C", "A,C", "'B'"),
            ("1.53,7.3617", "fast,7.3617", "'fast' is not a number"),
            ("1.53,7.3617", "nan,7.3617", "'nan' is not a number"),
            ("7.3617", "7,3617", "printed.csv"),
        ),
    ),
}
