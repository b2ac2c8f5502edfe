"""What the mass of an undamped follower does at the design frequency and beside it (Savin's Figs. 4 and 5)."""

from optlaws.results import Results

from .savin_follower import run

__all__ = ["run"]


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
