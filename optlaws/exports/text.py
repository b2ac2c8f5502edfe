"""Numbers, names, comments and headings in the files of controllers."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, Context
from functools import cache
from itertools import chain, count
from math import floor, inf, log10
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.exports.error_bounds import FloatingPoint, error_bounds
from optlaws.files import writing
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Array, chop
from optlaws.tolerances import VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.shown.summary import Summary

WIDTH = 110
_DIGITS = 15


class TextFile:
    """The file of an export, with a summary of what was written."""

    if TYPE_CHECKING:

        @property
        def text(self) -> str: ...

        def summary(self) -> Summary: ...

    def write(self, file: str | Path, *, force: bool = False) -> Path:
        """Write the file, completely or not at all.

        Raises
        ------
        InputError
            If it is there with other contents, and these are not to be replaced (`force`).
        """
        return writing.write(Path(file), self.text, exact=True, force=force)

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()


def real(value: float, *, single: bool = False) -> str:
    """A number with a point, as IEC 61131-3 and C both read it; for REAL32 the fewest digits that give it back.

    >>> real(1e-7), real(0.1), real(-35.0), real(0.1, single=True)
    ('1.0E-7', '0.1', '-35.0', '0.1')
    """
    text = str(np.float32(value)) if single else repr(float(value))
    mantissa, _, exponent = text.partition("e")
    mantissa = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{mantissa}E{int(exponent)}" if exponent else mantissa


def wrapped(items: Sequence[str], indent: str) -> list[str]:
    """Items with commas between them, in lines of bearable length."""
    lines: list[str] = []
    line = indent
    for i, item in enumerate(items):
        piece = item + (", " if i + 1 < len(items) else "")
        if len(line) + len(piece) > WIDTH and line != indent:
            lines.append(line.rstrip())
            line = indent
        line += piece
    return [*lines, line.rstrip()]


def safe(lines: Iterable[str]) -> list[str]:
    """Lines of a comment that cannot end it, nor nest one: in no language that is written here.

    >>> safe(["a */ b (* c *)", "two" + chr(10) + "lines"])
    ['a * / b ( * c * )', 'two', 'lines']
    """
    printable: list[str] = []
    for line in lines:
        for part in line.splitlines() or [""]:
            text = part
            for mark in ("*/", "/*", "(*", "*)", "//", "??"):
                text = text.replace(mark, f"{mark[0]} {mark[1]}")
            printable.append("".join(c if c.isprintable() else "?" for c in text.rstrip("\\ ")))
    return printable


@dataclass(frozen=True)
class Labels:
    """Units of master and slave as comments write them, and further text for a program.

    Examples
    --------
    >>> Labels("s", "mm").unit(2)
    'mm/s^2'
    """

    master: str = "s"
    slave: str = "mm"
    notes: tuple[str, ...] = ()

    def unit(self, nu: int) -> str:
        """The unit of a derivative."""
        return self.slave if nu == 0 else f"{self.slave}/{self.master}" + (f"^{nu}" if nu > 1 else "")


def program_heading(motion: PiecewiseMotion, labels: Labels, arithmetics: Sequence[FloatingPoint]) -> list[str]:
    """Lines that describe a program's function, its peaks, and the bound of its rounding errors."""
    count, plural = len(motion.coefficients), "s" if len(motion.coefficients) > 1 else ""
    interval = f"for x from {motion.start!r} to {motion.stop!r} {labels.master}"
    peaks = ((name, *motion.extremes(nu), labels.unit(nu), labels.master) for nu, name in enumerate(QUANTITIES))
    lines = [
        f"y(x) in {labels.slave} {interval}: {count} polynomial{plural} of degree {motion.degree}",
        *labels.notes,
        *(
            f"{name} from {chop(low.value, high.value, VALUE_ROUNDING):.9g} {unit} at x = {low.x:.9g} {of_x} "
            f"to {chop(high.value, low.value, VALUE_ROUNDING):.9g} {unit} at x = {high.x:.9g} {of_x}"
            for name, low, high, unit, of_x in peaks
        ),
    ]
    for arithmetic in arithmetics:
        bounds = error_bounds(motion, arithmetic)
        bounds_in_words = ", ".join(f"{rounded_up(bound)} {labels.unit(nu)}" for nu, bound in enumerate(bounds))
        lines += [f"rounding in {arithmetic.name}, proven, at most: {bounds_in_words}"]
    return lines


def rounded_up(bound: float) -> str:
    """A bound in three digits, none below it."""
    return f"{Context(prec=3, rounding=ROUND_CEILING).create_decimal_from_float(bound):.2e}"


def plain_column(values: Iterable[float], digits: int | None = None, decimal: str = ".") -> list[str]:
    """Numbers without an exponent: all digits of a double, or a given number of decimals.

    >>> plain_column([1e-05, 120.0]), plain_column([2.5, -1e-9], 3, ",")
    (['0.00001', '120'], ['2,500', '0,000'])
    """
    if digits is None:
        texts = [repr(value + 0.0) for value in values]
        texts = [
            np.format_float_positional(float(text), trim="-") if "e" in text else text.removesuffix(".0")
            for text in texts
        ]
    else:
        texts = [f"{value:.{digits}f}" for value in values]
        texts = [text[1:] if text.startswith("-") and not text.strip("-0.") else text for text in texts]
    return texts if decimal == "." else [text.replace(".", decimal) for text in texts]


def rounded_column(values: Array, digits: int | None = None) -> Array:
    """Numbers of a column with decimals, or with 15 digits of the greatest, beyond which doubles are rounded.

    >>> rounded_column(np.array([4.0e-17, 29.999999999999996, 40.0])).tolist()
    [0.0, 30.0, 40.0]
    """
    greatest = float(np.abs(values).max(initial=0.0))
    known = _DIGITS - 1 - floor(log10(greatest)) if 0.0 < greatest < inf else 0
    return np.round(values, known if digits is None else digits) + 0.0


def table_heading(motion: Motion, target: str) -> tuple[str, ...]:
    """The lines at the head of a file; the mark is at the end of the last."""
    units = motion.units
    rate = "" if units.rate is None or units.master == "s" else f", {units.rate:.9g} {units.master}/s"
    master = f"master in {units.master} from {motion.start:.9g} to {motion.stop:.9g}{rate}"
    return (f"{target}: {master}, slave in {units.slave}", *motion.proof, MARK)


def iec_comment(lines: tuple[str, ...]) -> str:
    """Lines as a comment of IEC 61131-3."""
    return "\n".join(["(*", *(f"   {line}" for line in safe(lines)), "*)", ""])


_PLAIN, _C_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*"), re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")
_LONGEST = 40  # characters of a name
_SHORT = 26  # characters, so that prefix and number have room in the shortest names of targets
_RUNS = re.compile(r"[^A-Za-z0-9]+")

_WORDS = """
    abs acos action add and any array asin at atan bit bool by byte case char concat configuration constant continue
    cos date date_and_time delete dint div do dt dword else elsif end_action end_case end_configuration end_for
    end_function end_function_block end_if end_program end_repeat end_resource end_step end_struct end_transition
    end_type end_var end_while eq exit exp expt extends external false find for from function function_block ge gt if
    implements in initial_step insert int interface interval into jmp le left len limit lint ln log lreal lt lword max
    method mid min mod move mul mux ne non_retain not of on or override persistent pointer priority private program
    property protected public read_only read_write real reference ref_to repeat replace resource retain return right
    rol ror sel shl shr sin single sint sqrt step string struct sub super task tan then this time time_of_day to tod
    transition true trunc type udint uint ulint until using usint var var_access var_config var_external var_global
    var_in_out var_input var_output var_temp wchar when while with word wstring xor
    ctd ctu ctud derivative f_trig hysteresis integral pid r_trig ramp rs rtc sema sr tof ton tp
"""
_C_WORDS = """
    auto break case char const continue default do double else enum extern float for goto if inline int long
    register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while
    alignas alignof and and_eq asm atomic bitand bitor bool catch class compl concept const_cast constexpr delete
    dynamic_cast explicit export false friend mutable namespace new noexcept not not_eq nullptr operator or or_eq
    private protected public reinterpret_cast requires static_assert static_cast template this thread_local throw
    true try typeid typename typeof using virtual wchar_t xor xor_eq
"""
#: keywords of C and C++
C_KEYWORDS = frozenset(_C_WORDS.split())
#: keywords of IEC 61131-3 and of the languages made of it, and the names of its functions and function blocks; no
#: variable may be called so, in whatever case
IEC_KEYWORDS = frozenset(_WORDS.split())


def iec_name(name: Any, target: str) -> str:
    """The name of a variable in a language of IEC 61131-3; the error of a target that would refuse it proposes one.

    >>> iec_name("press 1", "CODESYS")
    Traceback (most recent call last):
    optlaws.errors.InputError: CODESYS takes no variable called 'press 1': letters, digits and single _ ...'press_1'
    """
    if not isinstance(name, str) or not _PLAIN.fullmatch(name) or "__" in name or name.endswith("_"):
        why = "letters, digits and single _ between them make a name, a digit does not begin it"
    elif name.lower() in IEC_KEYWORDS:
        why = "it is a keyword"
    elif len(name) > _LONGEST:
        why = f"it may have {_LONGEST} characters"
    else:
        return name
    raise InputError(f"{target} takes no variable called {shortened(name)}: {why}; take {_proposed(name, _LONGEST)!r}")


def c_name(name: Any) -> str:
    """The name of a function in C and C++, short enough for every compiler with what is added to it."""
    if isinstance(name, str) and _C_NAME.fullmatch(name) and name not in C_KEYWORDS and "__" not in name:
        return name
    words = _RUNS.sub("_", name if isinstance(name, str) else "").strip("_")
    proposed = (words if words and words[0].isalpha() and words not in C_KEYWORDS else f"cam_{words}".rstrip("_"))[:31]
    raise InputError(
        f"C takes no name {shortened(name)}: letters, digits and single _, at most 31, no keyword; take {proposed!r}"
    )


def variable_names(names: Iterable[str]) -> dict[str, str]:
    """Variable names that every target accepts, different from each other without regard to case.

    >>> variable_names(["weld head", "Weld_head", "string", "2nd table"])
    {'weld head': 'weld_head', 'Weld_head': 'Weld_head_2', 'string': 'Cam_string', '2nd table': 'Cam_2nd_table'}
    """
    identifiers: dict[str, str] = {}
    taken: set[str] = set()
    for name in names:
        plain = _proposed(name, _SHORT)
        plain = f"Cam_{plain}" if plain.lower() in C_KEYWORDS else plain
        numbered = (f"{plain}_{number}" for number in count(2))
        identifiers[name] = next(candidate for candidate in chain([plain], numbered) if candidate.lower() not in taken)
        taken.add(identifiers[name].lower())
    return identifiers


def _proposed(name: Any, longest: int) -> str:
    words = _RUNS.sub("_", name if isinstance(name, str) else "").strip("_")
    words = words if words and not words[0].isdigit() else f"Cam_{words}".strip("_")
    words = words[:longest].rstrip("_")
    return f"Cam_{words}"[:longest] if words.lower() in IEC_KEYWORDS else words


_FOLDER = Path(__file__).with_name("templates")
#: of two texts the first where a word is among the choices, as preprocessors of C and of Structured Text take it
_CHOICE = re.compile(
    r"^(?:#if |\{IF defined \()(\w+)(?:\)\})?\n(.*?)^(?:#else|\{ELSE\})\n(.*?)^(?:#endif|\{END_IF\})\n",
    re.MULTILINE | re.DOTALL,
)


@cache
def template(file: str) -> str:
    """The text of a template by the name of its file."""
    return (_FOLDER / file).read_text("utf-8")


def filled(text: str, words: Mapping[str, object], choices: Collection[str] = ()) -> str:
    r"""A template with values in place of words, which may begin a longer name with _ behind them.

    A list of lines takes the place of the line that ends with its word, each behind what stands before that.

    >>> filled("#if LONG\n * NOTES\n#else\n#endif\nint name_LAST = LAST;", {"name": "a", "LAST": 3, "NOTES": ["b"]})
    'int a_LAST = 3;'
    >>> filled(" * NOTES", {"NOTES": ["b", "", "c"]}).splitlines()
    [' * b', ' *', ' * c']
    """
    chosen = _CHOICE.sub(lambda choice: choice[2 if choice[1] in choices else 3], text)

    def value(place: re.Match[str]) -> str:
        meant = words[place[2] or place[3]]
        return "\n".join((place[1] + line).rstrip() for line in meant) if isinstance(meant, list) else str(meant)

    lists = "|".join(word for word, meant in words.items() if isinstance(meant, list)) or "(?!)"
    names = "|".join(sorted(words, key=len, reverse=True))
    return re.sub(rf"^([ *]*)({lists})$|\b({names})(?![^\W_])", value, chosen, flags=re.MULTILINE)


def c_array(declared: str, values: Sequence[str]) -> list[str]:
    """Lines of a constant array of C, declared by its kind, its name and its length."""
    return [f"static const {declared} = {{", *wrapped(values, "    "), "};"]


def c_row(values: Sequence[str]) -> str:
    """A row of an array of arrays of C."""
    return "    {" + "\n".join(wrapped(values, "    ")).lstrip() + "}"


def st_array(name: str, kind: str, values: Sequence[str]) -> list[str]:
    """Lines of an array of Structured Text with its values."""
    return [f"    {name} : ARRAY[0..{len(values) - 1}] OF {kind} := [", *wrapped(values, "        "), "    ];"]


def fields(**values: object) -> str:
    """Fields of a structure with their values, floats as literals."""
    texts = ((name, real(value) if isinstance(value, float) else str(value)) for name, value in values.items())
    return ", ".join(f"{name} := {text}" for name, text in texts)


def st_records(name: str, kind: str, records: Sequence[str], indent: str = "    ") -> list[str]:
    """Lines of an array of structures, from 1, with the fields of each."""
    rows = ",\n".join(f"{indent}    ({record})" for record in records)
    return [f"{indent}{name} : ARRAY[1..{len(records)}] OF {kind} := [", rows, f"{indent}];"]
