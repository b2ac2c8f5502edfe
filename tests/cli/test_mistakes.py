"""What a user may mistake in a line: a command refuses it, names it with the remedy, and leaves nothing behind."""

import re
import shlex
from pathlib import Path

import pytest

from optlaws import smoothstep
from tests.documents import ROOT
from tests.internals.cli import RETIRED, exit_code
from tests.test_doors import INNER

#: texts of the packages that read words and files
OF_READERS = re.compile(r"Expected `|`\$\.|Unused Tokens|requires an argument")
CYCLE = """
job = "cycle"
title = "One axis"
speed = "100 rpm"
[[axis]]
name = "slide"
[[axis.segment]]
kind = "rise"
by = "10 mm"
duration = "120 deg"
[[axis.segment]]
kind = "return"
"""
#: a cycle with an entry that is wrong
CHANGED = {
    "still.toml": ('"10 mm"', '"0 mm"'),
    "stopped.toml": ('"100 rpm"', '"0 rpm"'),
    "back.toml": ('"120 deg"', '"-120 deg"'),
    "free.toml": ('name = "slide"', 'name = "slide"\ndegree = 0'),
    "rows.toml": ('speed = "100 rpm"', 'speed = "100 rpm"\nrows = 1'),
    "limit.toml": ('name = "slide"', 'name = "slide"\nlimits = { acceleration = "0 m/s^2" }'),
    "drive.toml": ('name = "slide"', 'name = "slide"\ndrive = { mass = "-2 kg" }'),
    "rack.toml": (
        'name = "slide"',
        'name = "slide"\nmechanism = { kind = "rack", radius = "20 mm", mass = "12 kg", colomb = "1 N" }',
    ),
    "export.toml": ('name = "slide"', 'name = "slide"\n[[axis.export]]\nto = "csv"\npoints = 10000000'),
}
TABLE = ROOT / "problems" / "cycle_rotary_table.toml"
FILES = {
    **{name: CYCLE.replace(old, new) for name, (old, new) in CHANGED.items()},
    "empty.json": "{}",
    "wrong.toml": "[problem]\norder = 2\n[vary]\nB = []\n",
    "open.json": "{",
    "list.json": "[]",
    "lawless.json": '{"law": {}}',
    "numbers.json": '{"law": [1]}',
    "front.json": '{"minimise": "C", "front": [1]}',
    "cubic.json": smoothstep(2).to_json(),
    "old.csv": "".join(f"{10 * k},{20.0 * (1.0 - abs(k - 18) / 18.0) ** 2}\n" for k in range(37)),
}
SOLVE = "solve --peak-velocity 1.641 --order 4 --degree 3"
MOVE = "solve --order 3 --fastest --stroke 5mm"
LIFT = "advise --points 0 --stroke 35mm --duration 0.1s"
SINE = "follower 'modified sine'"
TURN = "--natural-frequency '16.7 Hz' --speed '105 rpm' --rise '120 deg'"
EXPORT = "export cycloidal --stroke '35 mm' --master '120 deg' --time '0.1 s'"
#: the line, and what the answer names, as a regular expression
MISTAKES = {
    "solve --order 3 --most C": "'C'",
    "solve --order 3 --most C=0": "^C of at most 0",
    "solve --order 3 --most C=-1": "^C: ",
    "solve --order 3 --most-acceleration -1": "^C: ",
    "solve --order 3 --least C=9 --most C=3": "^C: ",
    "solve --order 3 --window b<=1.2@0.3..0.2": "window",
    "solve --order 3 --unsymmetric --inflexion 1.4": "inflexion",
    "solve --order 3 --basis pieces --breaks 0,0.5,0.3,1": "breaks",
    "solve --order 3 --basis pieces --breaks 4 --degree 3 --continuity 7": "continuity",
    "solve --order 3 --minimise 0*C": "weight",
    "solve --order 3 --minimise residual(frequency=(3,2))": "frequency",
    f"{MOVE} --limit jerk=0m/s^3": "jerk",
    f"{MOVE} --limit jerk=3m/s^2": "jerk",
    f"{MOVE} --limit velocity=1m/s --end-velocity 2m/s": "end_velocity",
    "solve --order 3 --fastest --stroke -5mm --limit jerk=3m/s^3": "stroke",
    "law nothing": "nothing",
    "law cycloidal --at 2": "--at",
    "compare cycloidal cycloidal": "cycloidal",
    "compare cycloidal 345 --frequency 0": "frequency",
    "follower cycloidal --natural-frequency 20Hz --time 1s --stroke -3mm": "stroke",
    "front --order 3 --points 1": "points",
    "front --order 3 --over B C": "nothing takes C",
    "export cycloidal --to csv --stroke 0mm --time 0.1s": "stroke",
    "export cycloidal --to csv --stroke 35mm --time -0.1s": "duration",
    "export cycloidal --to csv --stroke 35mm --time 0.1s --points 2000000": "points",
    "export still.toml --to csv": "still.toml.*by",
    "cycle stopped.toml": "stopped.toml.*speed",
    "cycle back.toml": "back.toml.*duration",
    "cycle free.toml --out results": "free.toml.*degree",
    "run rows.toml": "rows.toml: rows",
    "run limit.toml": "limit.toml.*acceleration",
    "run drive.toml --out results": "drive.toml.*mass",
    "run export.toml --out results": "export.toml.*points",
    "study wrong.toml": "wrong.toml.*vary",
    "verify empty.json": "empty.json",
    "verify none.json": "none.json",
    "advise --stroke 0mm --duration 1s": "by",
    "advise --stroke 35mm --duration 1s --mass -1kg": "mass",
    "advise --stroke 35mm --duration 1s --law nope": "nope",
    "advise --stroke 35mm --duration 1s --limit velocity=0m/s": "velocity",
    "new cycle cycle.txt": "toml",
    "explore nope --no-browser": "nope",
    "follower 'III(7.2)' --frequency 16.7Hz": "'16.7Hz'.*one in Hz is --natural-frequency, with --duration or --speed",
    "compare cycloidal 345 --frequency 16.7Hz": "a frequency with a unit needs the duration of the motion.*'16.7Hz'",
}
#: the line, and words of the answer
SAID = {
    "bogus": "bogus",
    "solv": "solve",
    "--bogus": "--bogus",
    "solve --peak-velocity 1 --order 4 --degree 3": "B must be a finite number above 1",
    f"{SOLVE} --minimise 'C/4 + Q/2'": "C/4 + Q/2 ^",
    f"{SOLVE} --basis splines": "--basis",
    f"{SOLVE} --monoton": "--monotone",
    f"{SOLVE} extra": "extra",
    f"{SOLVE} --minimise rms_C": "did you mean 'rms_c'?",
    f"{SOLVE} --most jerk=100": "did you mean 'J'?",
    f"{SOLVE} --minimise 'C + peak_jerk'": "did you mean 'J'?",
    f"{SOLVE} --stroke '1 mm'": "--stroke goes with --fastest",
    f"{SOLVE} --fastest": "--fastest needs --stroke",
    f"{SOLVE} --method ipopt --fastest --stroke '100 mm' --limit 'velocity=1 m/s'": "--method is of a single problem",
    f"{MOVE} --limit 'jerk=3 m/s^3' --limit 'jerk=3 m/s^3'": "is given twice",
    f"{MOVE} --limit '1 m/s'": "a limit is a name = a quantity",
    f"{MOVE} --limit 'jerk=3 m/s^3' --peak-velocity 1.8": "leaves B free",
    "solve --degree 3 --basis bsplines": "the basis 'bsplines' needs its breaks",
    "solve --degree 3 --breaks 8": "'chebyshev' has no breaks: leave it out, or take bsplines or periodic or pieces",
    "solve --degree 3 --basis bsplines --breaks '8 x'": "breaks are a number",
    "solve --degree 3 --basis bsplines --breaks '0 0.2 1'": "symmetric about 1/2",
    "solve --degree 3 --most rms_c": "such as rms_c=4",
    "solve --degree 3 --most rmsc=4": "did you mean",
    "solve --degree 3 --inflexion 2": "between 0 and 1",
    "solve --degree 5 --start 0,0": "as many values at the start as at the end, at least one; got 2 and 0",
    "solve --degree 5 --start 0,x --end 1,0": "start and end are numbers",
    "solve --degree 5 --order 3 --start 0,1 --end 1,0": "order 3 does not fit 2",
    "solve --degree 5 --order 4 --window 'b < 1'": "a window is written as",
    "solve --degree 5 --order 4 --window 'q <= 1'": "unknown quantity 'q'",
    "front --order 2 --bound tight --gap 1e-6": "give one of them",
    "front --order 4 --between 1.6 1.8 --within 1e-2 --name lift --output lift.st": "say --to c99 or --to iec-st",
    "law --z '1 2 x' --order 4": "'x'",
    "law --z nan --order 4": "z[0]",
    "law --z '1 inf' --order 4": "z[1]",
    "law --z '1 2' --order 0": "order",
    "law --order 4": "name a law, or give --z and --order",
    "law --z 1": "name a law, or give --z and --order",
    "law": "name a law, or give --z and --order",
    "law cycloidal --z 1 --order 4": "leave out 'cycloidal', or them",
    "law 'modifed sine'": "did you mean 'modified sine'",
    "law 0399": "50 hundredths",
    "law III": "family III need --alpha or --peak-velocity: alpha is from -6 to 12",
    "law III --alpha 13": "between -6 and 12",
    "law III --alpha 1 --peak-velocity 2": "got alpha and B",
    "law cubic --alpha 1": "choose a member of a family",
    "law cubic --at 2": "k must be in [0, 1]",
    "law 'III(13)'": "between -6 and 12",
    "law 'III(seven)'": "such as III(7.2) or III(B=1.8), got 'III(seven)'",
    "law 'III(C=7)'": "by alpha or B",
    "law 'III(7.2)' --alpha 1": "choose a member of a family",
    "law nowhere.json": "cannot read nowhere.json",
    "law cubic --samples 5": "--csv FILE",
    "law cubic --plot cubic.pdf": ".png or .svg",
    "law cubic --plot .": ".png or .svg",
    **{f"law {file}.json": f"{file}.json holds no law" for file in ("front", "list", "empty", "numbers")},
    "catalogue qwerty": "no law is like 'qwerty'",
    "follower II --alpha 7 --frequency 20 --design-frequency 20": "jerk j(0) = 120, so the velocity of the cam",
    "follower IV --frequency 20": "need --alpha",
    "follower cycloidal --alpha 1 --frequency 20": "no other takes it",
    "follower IV --alpha 20 --frequency 20": "alpha",
    "follower cycloidl --frequency 20": "did you mean 'cycloidal'",
    "follower cycloidal": "--frequency or, with units, --natural-frequency such as '16.7 Hz' or --natural-period",
    "follower cycloidal --frequency 20 --speed '100 rpm'": "give no --frequency beside",
    "follower cycloidal --frequency -20": "frequency must be above 0",
    "follower cycloidal --frequency 20 --damping -1": "damping must be at least 0",
    "follower cycloidal --frequency 20 --design-damping 0.1": "--design-damping needs --design-frequency",
    "follower cycloidal --frequency 20 --plot x.pdf --spectrum 1 2": "ends in .png or .svg",
    "follower cycloidal --frequency 20 --spectrum 2 9": "name the file too",
    "follower cycloidal --frequency 20 --plot x.png --spectrum 9 2": "two rising numbers above 0",
    "follower missing.json --frequency 20": "missing.json",
    "follower open.json --frequency 20": "is not JSON",
    "follower list.json --frequency 20": "holds no law",
    "follower lawless.json --frequency 20": "a law has a 'kind'",
    f"{SINE} {TURN} --frequency 20": "give no --frequency",
    f"{SINE} --frequency 20 --stroke 35mm": "--stroke needs the time",
    f"{SINE} --natural-frequency '16.7 Hz'": "give duration",
    f"{SINE} --natural-frequency 16.7 --time '0.1 s'": "without a unit",
    f"{SINE} --natural-frequency '60 ms' --time '0.1 s'": "--natural-frequency must be a frequency",
    f"{SINE} {TURN} --natural-period '60 ms'": "and not both",
    f"{SINE} --speed '105 rpm' --rise '120 deg'": "give either --frequency or, with units, --natural-frequency",
    "export --to csv": "optlaws export LAW --to FORMAT",
    EXPORT: "--to FORMAT",
    f"{EXPORT} --to cvs": "did you mean 'csv'",
    "export cycloidal --to csv": "stroke",
    f"{EXPORT} --to csv --points many": "--points",
    f"{EXPORT} --to codesys-xyva --digits 3": "codesys-xyva takes no digits",
    f"{EXPORT} --to csv --axis table": "--axis",
    f"export {TABLE} --to csv": "weld head",
    f"export {TABLE} --to csv --axis x": "weld head",
    f"export {TABLE} --to csv --stroke '1 mm'": "a cycle has its own",
    **{f"cycle old.csv --unit mm --master deg --speed={speed}": "must be above 0" for speed in ("0rpm", "-5rpm")},
    "cycle old.csv --unit mm --master deg --speed=3mm": "is a length",
    **{
        f"cycle old.csv --unit mm --master deg --modernise{off}": f"above 0, got '{off[1:]}': give how far better laws"
        for off in (" -0.05mm", "=-0.05mm", " 0mm")
    },
    "cycle old.csv --modernise --save new.toml": "value for --modernise: none is given, as --save follows",
    "advise": "give a problem file, or --stroke",
    "advise --stroke 35mm": "give a problem file, or --stroke",
    "advise --stroke 35kg --duration 0.1s": "--stroke must be a length such as",
    "advise --stroke 35mm --duration 3mm": "--duration must be a time such as",
    "advise --stroke 35mm --duration 110deg": "is an angle of the master: give its --speed too",
    "advise cycle_press --stroke 35mm": "are of a single move",
    "advise cycle_press --axis nobody": "nobody",
    "advise lever_tables": "lever_tables",
    f"{LIFT} --frequency 30": "frequency",
    f"{LIFT} --frequency 30Hz --frequency 30Hz --frequency 30Hz": "once, or twice",
    f"{LIFT} --law 'modified sin'": "did you mean 'modified sine'",
    "cycle rack.toml": "rack.toml: axis slide: mechanism: unknown entry of a rack 'colomb'; did you mean 'coulomb'",
    "cycle lever_nomogram --json": "lever_nomogram",
    "new drive new.toml --efficiency 1.2": "--efficiency",
    "new cycle --stroke 35": "a length such as '35 mm' or an angle such as '45 deg', got '35' without a unit",
    "new cycle --stroke '35 kg'": "--stroke must be a length such as '35 mm' or an angle",
    "new cycle --stroke '0 mm'": "--stroke must be above 0",
    "new cycle --stroke '90 deg' --velocity '1 m/s'": "angular velocity",
    "new cycle --mass '2 kg' --stroke '90 deg'": "--mass must be a moment of inertia",
    "new cycle --dwell '200 deg'": "cycle.toml: axis slide: ",
    "new cycle --roller '12 mm'": "cycle: unknown option '--roller'",
    "new cam --presure-angle '30 deg'": "did you mean '--pressure-angle'?",
    "new law --minimise E": "unknown --minimise 'E'",
    "new law --order 2.5": "--order must be a whole number from 1 ",
    "new machine --damping much": "--damping must be a number from 0 on, got 'much'",
    "new study --from 2 --to 1.5": "--from and --to are peak velocities above 1",
    "new study --from 0.9": "--from must be above 1, got 0.9",
    "new cam --stroke '90 deg'": "--stroke must be a length",
    "new machine --spread 2": "--spread must be at most 1, got 2",
    "new drive new.toml --stroke '40 mm'": "--stroke must be an angle",
    "new mechanism --rod '50 mm'": "mechanism.toml: axis crank: mechanism: ",
    "new mechanism --mass '2 kg m^2'": "--mass must be a mass",
    "new fastest --stroke '90 deg' --jerk '9 m/s^3'": "--jerk must be an angular jerk",
    "new interlock --clear '60 mm'": "--clear must be below --stroke, 50 mm, got 60 mm",
    "new interlock --within '1 mm'": "--within must be an angle",
    "new cycle slide.txt": "a problem file's name ends in .toml",
    "new lever": "lever",
    "run": "at least one problem file",
    "run none.toml": "cannot read none.toml",
    "run savin_familys": "did you mean 'savin_families'?",
    "verify .": "folder",
    "run still.toml still.toml --out results": "--out",
    **{f"{command} anything --json": text for command, text in RETIRED.items()},
}


@pytest.mark.parametrize(
    ("line", "named"), [*MISTAKES.items(), *((line, re.escape(words)) for line, words in SAID.items())]
)
def test_a_mistake_is_named_and_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], line: str, named: str
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, content in FILES.items():
        (tmp_path / name).write_text(content, "utf-8")
    before = sorted(tmp_path.rglob("*"))
    assert exit_code(shlex.split(line)) == 2
    assert sorted(tmp_path.rglob("*")) == before
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("optlaws: ")
    text = " ".join(err.removeprefix("optlaws: ").split())
    assert re.search(named, text), text
    assert not INNER.search(text), text
    assert not OF_READERS.search(text), text
