"""A die that does not wait
========================

A die opens and closes while its table moves, as far as two interlocks allow. Arrows show which event comes first.
"""

from optlaws import After, Axes, Dwell, Return, Rise

index = [Dwell("105 deg"), Rise("100 mm", "150 deg", law="cycloidal", name="index"), Dwell()]
opens, closes = (kind("50 mm", "55 deg", law="cycloidal") for kind in (Rise, Return))
die = [Dwell("50 deg"), opens, Dwell(), closes, Dwell("50 deg")]
rules = [
    After("table", "0.65 mm", of="die", above="31 mm"),
    After("die", "31 mm", of="table", above="99.35 mm", way="down"),
]
machine = Axes({"table": {"segments": index, "advance": "100 mm"}, "die": die}, speed="60 rpm", interlocks=rules)
machine.least_acceleration("die").axes.plot(what="timing")
