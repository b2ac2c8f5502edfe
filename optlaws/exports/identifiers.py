"""Names of variables as targets take them; what one refuses is said with a name that it takes."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import chain, count
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
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
#: keywords of IEC 61131-3 and of the languages made of it; no variable may be called so, in whatever case
IEC_KEYWORDS = frozenset(_WORDS.split())


def iec_name(name: Any, target: str, longest: int = 40) -> str:  # noqa: ANN401 - it is checked here
    """The name of a variable in a language of IEC 61131-3.

    Parameters
    ----------
    name
        The name.
    target
        What an error calls the target.
    longest
        How many characters it may have.

    Raises
    ------
    InputError
        If the target would refuse it; the error proposes one that it takes.

    Examples
    --------
    >>> iec_name("Press_1", "CODESYS")
    'Press_1'
    >>> iec_name("press 1", "CODESYS")
    Traceback (most recent call last):
    optlaws.errors.InputError: CODESYS takes no variable called 'press 1': letters, digits and single _ ...'press_1'
    """
    why = _fault(name, longest)
    if why:
        proposed = _proposed(name, longest)
        raise InputError(f"{target} takes no variable called {shortened(name)}: {why}; take {proposed!r}")
    return str(name)


def variable_names(names: Iterable[str]) -> dict[str, str]:
    """For each name one that every target takes for a variable, and no two alike whatever the case of letters.

    Examples
    --------
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


def _fault(name: Any, longest: int) -> str:  # noqa: ANN401
    if not isinstance(name, str) or not _PLAIN.fullmatch(name) or "__" in name or name.endswith("_"):
        return "letters, digits and single _ between them make a name, a digit does not begin it"
    if name.lower() in IEC_KEYWORDS:
        return "it is a keyword"
    return f"it may have {longest} characters" if len(name) > longest else ""


def _proposed(name: Any, longest: int) -> str:  # noqa: ANN401
    words = _RUNS.sub("_", name if isinstance(name, str) else "").strip("_")
    words = words if words and not words[0].isdigit() else f"Cam_{words}".strip("_")
    words = words[:longest].rstrip("_")
    return f"Cam_{words}"[:longest] if words.lower() in IEC_KEYWORDS else words
