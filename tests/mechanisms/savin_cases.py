"""The experiment's cams and the tables of reference numbers that belong to them."""

import csv
from functools import cache

from optlaws import MotionLaw, catalogue, polydyne, savin
from tests.documents import ROOT

ALPHA = {"III": 7.2, "IV": 11.0}


def rows(name: str) -> list[dict[str, str]]:
    lines = (ROOT / "tests" / "reference" / f"savin_{name}.csv").read_text("utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


@cache
def reference(law: str) -> MotionLaw:
    """The law meant for the mass: of a family, or the simple harmonic one, K."""
    family = law.removesuffix("_rigid")
    return catalogue["simple harmonic"].law if family == "K" else savin(family, ALPHA[family])


@cache
def cam(law: str, n_design: str) -> MotionLaw:
    """What is cut on the cam: for nu = 20 and n_design, or the law itself where there is none."""
    return polydyne(reference(law), frequency=20, damping=float(n_design) / 20) if n_design else reference(law)
