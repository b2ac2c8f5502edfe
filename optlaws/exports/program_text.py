"""Programs from their templates, C headers and Structured Text that compilers of these languages take as they are."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from functools import cache
from pathlib import Path

from optlaws.exports.text import wrapped

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
    """Lines of a constant array of C, declared by its kind, its name and its length.

    >>> c_array("double breaks[2]", ["0.0", "1.0"])
    ['static const double breaks[2] = {', '    0.0, 1.0', '};']
    """
    return [f"static const {declared} = {{", *wrapped(values, "    "), "};"]


def c_row(values: Sequence[str]) -> str:
    """A row of an array of arrays of C.

    >>> c_row(["0.0", "1.0"])
    '    {0.0, 1.0}'
    """
    return "    {" + "\n".join(wrapped(values, "    ")).lstrip() + "}"


def st_array(name: str, kind: str, values: Sequence[str]) -> list[str]:
    """Lines of an array of Structured Text with its values.

    >>> st_array("breaks", "LREAL", ["0.0", "1.0"])
    ['    breaks : ARRAY[0..1] OF LREAL := [', '        0.0, 1.0', '    ];']
    """
    return [f"    {name} : ARRAY[0..{len(values) - 1}] OF {kind} := [", *wrapped(values, "        "), "    ];"]
