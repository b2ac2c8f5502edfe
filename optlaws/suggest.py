"""Messages for unknown names, with the nearest known one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from inspect import Parameter, signature
from typing import Any, TypeVar

from optlaws.echo import shortened

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
    return next(iter([*same, *meant, *get_close_matches(name, names, n=1)]), None)
