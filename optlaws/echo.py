"""What errors show of given values: shortened where they are long, and the nearest of the names that are known."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from inspect import Parameter, signature
from reprlib import Repr
from typing import Any, TypeVar

LONGEST = 2000


class _Echo(Repr):
    """Values as errors show them: bounded in length and in depth, whatever they are."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxstring, self.maxother, self.maxlong = 3, 80, 120, 40
        self.maxlist = self.maxtuple = self.maxdict = self.maxset = self.maxarray = 12

    def repr_int(self, x: int, level: int) -> str:
        if x.bit_length() > 400:
            return f"{'-' if x < 0 else ''}an integer of {x.bit_length()} bits"
        return super().repr_int(x, level)

    def repr_instance(self, x: object, level: int) -> str:
        try:
            if type(x).__module__ == "numpy" and hasattr(x, "tolist"):
                return self._of_numpy(x, level)
            return super().repr_instance(x, level)
        except (RecursionError, ValueError, OverflowError, MemoryError):
            return f"<{type(x).__name__}>"

    def _of_numpy(self, x: Any, level: int) -> str:
        """An array or a number of numpy as plain lists and numbers, of which no more are made than are shown."""
        some = x[(slice(0, self.maxlist + 1),) * x.ndim].tolist() if x.ndim else x.item()
        return self.repr1(some, level)


_ECHO = _Echo()


def shortened(value: object) -> str:
    """The repr of a value, shortened where it is long or deep, for the text of an error.

    Examples
    --------
    >>> shortened([1, 2.5]), shortened(10**400)
    ('[1, 2.5]', 'an integer of 1329 bits')
    >>> import numpy as np
    >>> shortened(np.array([[1.5, 2.0]])), shortened(np.float64(3.0))
    ('[[1.5, 2.0]]', '3.0')
    """
    return _ECHO.repr(value)


def cut(text: str, most: int = LONGEST) -> str:
    r"""The text as it can be stored and printed anywhere: not longer than `most`, its surrogates escaped.

    Examples
    --------
    >>> cut("0123456789", most=5), cut("a" + chr(0xD800))
    ('01...', 'a\\ud800')
    """
    short = text if len(text) <= most else f"{text[: most - 3]}..."
    plain = short.encode("utf-8", "backslashreplace").decode("utf-8")
    return text if plain == text else plain  # a sentence stays one


#: what people call the constants of a law
CONSTANTS = {"velocity": "B", "speed": "B", "acceleration": "C", "power": "D", "jerk": "J"}

_LONGEST_NAME = 100

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])


def unknown_key(
    name: object, known: Iterable[str], what: str = "key", *, words: Mapping[str, str] | None = None
) -> str:
    """A sentence that names the nearest right name, or all of them; `words` are other words for some of them.

    Examples
    --------
    >>> unknown_key("monoton", ["monotone", "order"])
    "unknown key 'monoton'; did you mean 'monotone'?"
    >>> unknown_key("rms_C", ["rms_c", "rms_j"], "constant")
    "unknown constant 'rms_C'; did you mean 'rms_c'?"
    >>> unknown_key("jerk", ["C", "J"], "constant", words={"jerk": "J"})
    "unknown constant 'jerk'; did you mean 'J'?"
    """
    names = sorted(known)
    near = _nearest(name, names, words or {}) if isinstance(name, str) and len(name) <= _LONGEST_NAME else None
    if near is not None:
        return f"unknown {what} {name!r}; did you mean {near!r}?"
    return f"unknown {what} {shortened(name)}; known are {', '.join(names)}"


def keywords_of(options: type, **defaults: Any) -> Callable[[FunctionT], FunctionT]:
    """A decorator for functions whose `**keywords` are the entries of a `TypedDict`, None or a default unless given.

    They stand in the signature by their names. One that is required and missing, and any other, is refused as Python
    refuses it, with a suggestion.

    Examples
    --------
    >>> from typing import TypedDict
    >>> @keywords_of(TypedDict("Options", {"points": int}, total=False))
    ... def export(to, **options):
    ...     return to, options
    >>> export("csv", points=7), str(signature(export))
    (('csv', {'points': 7}), '(to, *, points: int = None)')
    >>> export("csv", pionts=7)
    Traceback (most recent call last):
    TypeError: export() got an unexpected keyword argument 'pionts'; did you mean 'points'?
    """
    required: frozenset[str] = getattr(options, "__required_keys__", frozenset())

    def decorated(function: FunctionT) -> FunctionT:
        bare = signature(function)
        named = [parameter for parameter in bare.parameters.values() if parameter.kind is not Parameter.VAR_KEYWORD]
        named += [
            Parameter(
                name,
                Parameter.KEYWORD_ONLY,
                default=Parameter.empty if name in required else defaults.get(name),
                annotation=getattr(kind, "__forward_arg__", kind),
            )
            for name, kind in options.__annotations__.items()
        ]
        known = {parameter.name for parameter in named}

        @wraps(function)
        def checked(*args: Any, **keywords: Any) -> Any:
            for name in keywords.keys() - known:
                near = unknown_key(name, known, "keyword argument").partition("; did")
                message = f"{function.__qualname__}() got an unexpected keyword argument {name!r}"
                raise TypeError(message + "".join(near[1:]))
            for name in required - keywords.keys():
                raise TypeError(f"{function.__qualname__}() missing a required keyword argument: {name!r}")
            return function(*args, **keywords)

        checked.__signature__ = bare.replace(parameters=named)  # type: ignore[attr-defined]
        return checked  # type: ignore[return-value] # the same function but for the check

    return decorated


def _nearest(name: str, names: list[str], words: Mapping[str, str]) -> str | None:
    """The name with other capitals, the name of a synonym, or the most similar name."""
    from difflib import get_close_matches

    folded = name.casefold()
    same = [known for known in names if known.casefold() == folded]
    meant = [known for word, known in words.items() if word in folded.split("_") and known in names]
    near = (each if each in names else words[each] for each in get_close_matches(name, [*names, *words], n=3))
    return next((each for each in [*same, *meant, *near] if each in names), None)
