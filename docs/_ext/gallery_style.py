"""The gallery's pictures have the style of all others."""

from pathlib import Path


def use(_configuration: dict[str, object], _file: str | Path) -> None:
    """Begin every example with the project's style."""
    import matplotlib as mpl

    from optlaws.plots.style import STYLE

    mpl.rcParams.update(STYLE)
