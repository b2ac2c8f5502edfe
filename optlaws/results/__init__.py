"""Tables, pictures and pages of results, in one style, for scripts over the public names of optlaws."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.files.tables": "Cell",
        "optlaws.files.writing": "MARK",
        "optlaws.results.printed": "MISPRINT ON_GRID REPRODUCED PrintedNumber compared number rows same_digits",
        "optlaws.results.results": "Entries Page Results read",
        "optlaws.suggest": "unknown_key",
    },
)
