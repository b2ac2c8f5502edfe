"""Problems of every kind whose files are verified."""

from optlaws import (
    BoundaryConditions,
    BSplines,
    Chebyshev,
    Pieces,
    Problem,
    Window,
    at_least,
    at_most,
    between,
    cam_constant,
    residual_vibration,
    via,
)

DEGREE_9 = Chebyshev(9)
MOVING = BoundaryConditions((0, 0.3), (1, 0.1))
CONVEX = [
    Problem(B=1.859, order=4, basis=Chebyshev(9)),
    Problem(B=1.5, order=5, basis=Chebyshev(21)),
    Problem(B=2.5, order=4, basis=Chebyshev(9), monotone=True),
    Problem(B=1.4, order=2, basis=Chebyshev(15)),
    Problem(B=2.1, order=6, basis=Chebyshev(9)),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="J"),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="rms_c"),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="max(C/4, J/30)"),
    Problem(B=1.8, order=3, basis=Chebyshev(9), minimise="0.5*C/4 + 0.5*J/12"),
    Problem(B=1.8, order=4, basis=Chebyshev(11), J=80.0),
    Problem(B=at_most(1.6), order=4, basis=Chebyshev(9)),
    Problem(B=1.859, order=4, basis=Chebyshev(9), symmetric=False),
    Problem(order=2, basis=Chebyshev(7), symmetric=False, boundary=MOVING),
    Problem(order=3, basis=Chebyshev(9), windows=(via("a", 0.3, at=0.4),), symmetric=False),
    Problem(order=3, basis=Chebyshev(9), windows=(Window("c", -6.0, 2.0, 0.3, 0.6),)),
]
LOCAL = [
    Problem(B=1.7, order=4, basis=Chebyshev(9), minimise="D"),
    Problem(B=1.7, order=4, basis=Chebyshev(9), minimise="0.5*C/4 + 0.5*D/2.25"),
    Problem(B=1.7, order=4, basis=Chebyshev(9), D=8.0),
]
PIECES = [
    Problem(B=1.75, order=4, basis=Pieces(4)),
    Problem(B=1.75, order=2, basis=Pieces(8, 3, 2)),
    Problem(B=1.75, order=2, basis=Pieces((0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0), 3, 1)),
    Problem(B=1.75, order=3, basis=Pieces(8), minimise="rms_c"),
    Problem(B=1.75, order=3, basis=Pieces(6), minimise="max(C/4, J/40)", monotone=True),
    Problem(B=1.75, order=3, basis=Pieces(5), symmetric=False),
    Problem(B=2.3, order=4, basis=Pieces.around((0.0, 0.3, 0.7, 1.0), 0.02)),
    Problem(B=at_most(1.6), order=4, basis=Pieces(8, 6, 4), bounds={"rms_j": at_most(60)}),
    Problem(order=3, basis=Pieces(6), symmetric=False, windows=(via("a", 0.3, at=0.4),)),
    Problem(order=2, basis=Pieces(6), symmetric=False, inflexion=0.4, B=1.7),
    Problem(order=2, basis=Pieces(4), symmetric=False, boundary=MOVING, minimise="rms_c"),
    Problem(B=1.75, order=3, basis=Pieces(6), minimise="0.5*C/4 + 0.5*D/2.25"),
    Problem(B=1.75, order=4, basis=BSplines(6, 3)),
    Problem(B=1.75, order=4, basis=BSplines(5, 3), symmetric=False, minimise="J"),
    Problem(B=2.5, order=4, basis=BSplines(6, 4, 2), monotone=True),
    Problem(B=1.75, order=3, basis=BSplines((0.0, 0.1, 0.4, 0.6, 0.9, 1.0), 3, 1)),
    Problem(order=3, basis=BSplines(6, 4), windows=(Window("c", -6.0, 2.0, 0.3, 0.6),)),
]
KINDS = [
    *(
        Problem(order=4, basis=DEGREE_9, **given)
        for given in (
            {"B": 1.8, "symmetric": False, "inflexion": 0.4},
            {"symmetric": False, "inflexion": 0.4, "minimise": "max(C_plus, C_minus/2)"},
            {"B": 1.8, "bounds": {"rms_c": at_most(3.82)}},
            {"B": 1.8, "bounds": {"snap": at_most(900)}},
            {"symmetric": False, "bounds": {"C_minus": at_most(4)}, "minimise": "C_plus"},
        )
    ),
    Problem(B=1.5, order=1, basis=DEGREE_9),
    Problem(B=1.9, order=6, basis=Chebyshev(11), minimise="snap"),
    Problem(B=1.9, order=3, basis=DEGREE_9, minimise="rms_j"),
    Problem(B=1.75, order=2, basis=DEGREE_9, minimise="C_plus"),
    Problem(B=1.75, order=3, basis=DEGREE_9, minimise="C_plus", symmetric=False),
    Problem(order=3, basis=DEGREE_9, minimise="C_minus", windows=(Window("a", 0.4, 0.6, 0.45, 0.55),)),
    Problem(order=3, basis=DEGREE_9, windows=(Window("b", high=1.5, start=0.2, stop=0.8),)),
    Problem(order=3, basis=DEGREE_9, minimise="J", windows=(Window("c", high=3.5, start=0.2, stop=0.8),)),
    Problem(order=3, basis=DEGREE_9, minimise="C", J=at_most(70)),
    Problem(order=4, basis=DEGREE_9, B=between(1.5, 1.8), bounds={"snap": at_most(3000)}),
    Problem(order=4, basis=DEGREE_9, B=at_least(2.0), minimise="max(C/4, J/32) + 0.2*rms_c"),
    Problem(order=3, basis=DEGREE_9, B=1.75, minimise="C + J/30", J=between(70, 80)),
    Problem(order=3, basis=DEGREE_9, B=1.7, symmetric=False, inflexion=0.4),
    Problem(order=2, basis=DEGREE_9, symmetric=False, boundary=BoundaryConditions((0, 0.5), (1, 0)), monotone=True),
    Problem(order=2, basis=Chebyshev(5), minimise="D"),
]


def moving(start: tuple[float, ...], end: tuple[float, ...], minimise: str = "C") -> Problem:
    return Problem(boundary=BoundaryConditions(start, end), minimise=minimise, symmetric=False, basis=Chebyshev(5))


ONCE_REFUSED = {
    "zero": moving((0, 1, 0), (1, 1, 0)),
    "zero snap": moving((0, -0.467), (1, 0.003), "snap"),
    "zero maximum": Problem(order=1, minimise="max(0.00038*rms_snap, 9.8e-05*snap)", monotone=True, basis=Chebyshev(8)),
    "one-sided": moving((0, 2), (1, 0), "max(C_plus, 0.1*C_minus)"),
    "below zero": moving((0, 2, -1), (1, 0, -1), "C_plus"),
    "one-sided peaks in a sum": moving((0, 1, 0), (1, 0, 0), "C_plus + 0.2*C_minus + 0.1*rms_c"),
    "power from below": Problem(order=3, B=1.9, minimise="rms_c", basis=Chebyshev(9), D=at_least(4.0)),
    "rounded breaks": Problem(
        order=3, B=1.7, basis=Pieces([0, 0.1, 0.43, 0.5, 0.5699999999999994, 0.9000000000000005, 1], 5, 2)
    ),
}

OF_CAMS = {
    "acceleration": Problem(order=4, minimise=cam_constant("C", frequency=20), basis=Chebyshev(7)),
    "damped": Problem(order=4, minimise=cam_constant("C", frequency=20, damping=0.1), basis=Chebyshev(7)),
    "one-sided": Problem(
        order=4, minimise=cam_constant("C_plus", frequency=15, damping=0.1), symmetric=False, basis=Chebyshev(6)
    ),
    "pieces": Problem(order=4, minimise=cam_constant("C_minus", frequency=20, damping=0.1), basis=Pieces(4, 6, 3)),
    "velocity alone": Problem(order=5, minimise=cam_constant("B", frequency=12, damping=0.1), basis=Chebyshev(7)),
    "jerk": Problem(
        order=5, minimise=cam_constant("J", frequency=12, damping=0.1), symmetric=False, basis=Chebyshev(7)
    ),
    "sum": Problem(order=5, minimise="0.5*C + 0.1*J_cam(frequency=12, damping=0.05)", basis=Chebyshev(7)),
    "bounded": Problem(order=4, minimise="C", bounds={"C_cam(frequency=10)": at_most(7.0)}, basis=Chebyshev(9)),
    "velocity": Problem(order=4, minimise="C", bounds={"B_cam(frequency=9)": at_most(1.7)}, basis=Chebyshev(9)),
    "power": Problem(order=4, minimise=cam_constant("D", frequency=20, damping=0.1), basis=Chebyshev(7)),
    "power, not symmetric": Problem(
        order=4, minimise=cam_constant("D", frequency=20, damping=0.1), symmetric=False, basis=Chebyshev(4)
    ),
    "both powers": Problem(order=4, minimise="D + D_cam(frequency=20)", basis=Chebyshev(7)),
}

RESIDUALS = {
    "one frequency": Problem(order=4, minimise="residual(frequency=18) + 0.1*C", C=at_most(7), basis=Chebyshev(7)),
    "nothing left": Problem(order=4, minimise="residual(frequency=18)", C=at_most(7), basis=Chebyshev(7)),
    "interval": Problem(
        order=4, minimise="residual(frequency=(9, 12), damping=0.03)", B=1.8, C=at_most(7), basis=Chebyshev(7)
    ),
    "bounded": Problem(
        order=4, minimise="C", bounds={"residual(frequency=(18, 22))": at_most(0.5)}, basis=Chebyshev(9)
    ),
    "with a design": Problem(
        order=4,
        minimise="C",
        symmetric=False,
        bounds={"residual(frequency=(18, 22), damping=0.02, design=20)": at_most(0.5)},
        basis=Pieces(4, 6, 3),
    ),
    "displacement": Problem(
        order=3,
        bounds={residual_vibration(frequency=(6, 7), of="displacement"): at_most(0.002)},
        basis=Chebyshev(11),
    ),
    "weighed": Problem(
        order=3,
        minimise=residual_vibration(spectrum=[(16, 0.2), (18, 1.0), (19, 0.6), (22, 1.5), (27, 0.1)]),
        B=at_most(2),
        C=at_most(7),
        basis=Chebyshev(7),
    ),
    "symmetric pieces": Problem(order=4, minimise="0.2*C + residual(frequency=(12, 14))", basis=Pieces(4, 6, 3)),
}

TABLE = "table(k, 0:1, 0.3:2, 0.7:1, 1:3)"
OF_FORMULAS = [
    *(f"rms({text})" for text in ("sin(3*k)*b + c", f"{TABLE}*sin(k)*b + c", "abs(k - 0.3)*b + c", "c/(1 + k)")),
    *(f"integral({text})" for text in ("exp(k)*c^2 + b^2", "exp(c/5)", "abs(k - 0.3)*c^2 + b^2", "norm(1, c/20)")),
    *(
        f"peak({text})"
        for text in ("abs(k - 0.3)*b + c", f"{TABLE}*sin(k)*b + c", "max(k, 0.5)*b + c", "norm(b, c, 1)")
    ),
    "peak(table(a, 0:1, 0.5:1, 1:3) + c, side=high)",
    "peak(spline(a, 0:1.25, 0.2:0.27, 0.4:0.01, 0.6:0.01, 0.8:0.27, 1:1.25) + abs(c), side=high)",
    "rms(norm(b, c))",
    "integral(max(k, 0.4)*c^2)",
    "integral(max(c^2, 9*b^2))",
    "integral(table(c, -9:9, 0:0, 9:4) + exp(b))",
    "peak(c + 0.2*b)",
    "peak((1 + k)*c, side=high)",
    "peak(c + table(k, 0:0, 0.5:1, 1:0)*b, start=0.1)",
    "rms((1 + k^2)*c + 3*b)",
    "peak(norm(c, 3*b))",
    "peak(abs(c) + 2*abs(b))",
    "integral((c + 2*b)^2, start=0.2, stop=0.9)",
    "rms(c^2 + b^2)",
    "value(c^2 + b, at=0.3)",
    "max(peak(c + 3*b), 2*rms(c), C_plus) + 0.5*integral(b^2)",
    *(f"integral({text})" for text in ("abs(j)", "(1 + k)*abs(c)", "abs(c - 2*b)", "abs(j + 3*c) + max(c, -2*c)")),
]
#: which bound their laws without a bound of the velocity
ALONE = [
    Problem(order=3, basis=Chebyshev(13), symmetric=False, minimise=each)
    for each in (
        "peak(0.0753982237*c + max(0.591358617*c, 0.427256601*c), side=high)",
        "peak(c^2 + c, side=high)",
        "peak(max(c, 2*b), side=high)",
        "peak(min(-abs(j), -2*abs(c)), side=low)",
        "peak(exp(c/10) - b, side=high)",
        "integral(max(c, 0) + 0.1*abs(j))",
    )
]
WINDOWS = [
    (Window("c + 0.2*b", high=4.8, start=0.1, stop=0.6), "C"),
    (via("c + 3*b - 4*a", 1.0, at=0.3), "C"),
    (Window("c^2 + 9*b^2", high=33.0), "J"),
    (Window("abs(c) + abs(b)", high=5.4, start=0.2), "C"),
    (Window("c + k*b", low=-4.9), "rms_c"),
]
FORMULAS = [
    problem
    for symmetric in (True, False)
    for problem in (
        *(Problem(B=1.9, order=3, basis=Chebyshev(7), minimise=each, symmetric=symmetric) for each in OF_FORMULAS),
        *(
            Problem(B=1.8, order=4, basis=DEGREE_9, windows=(each,), minimise=minimise, symmetric=symmetric)
            for each, minimise in WINDOWS
        ),
    )
]
BOUNDED_FORMULAS = [
    Problem(B=1.7, C=at_most(9.0), order=4, symmetric=False, basis=BSplines(4, 5, 4), minimise=each)
    for each in OF_FORMULAS
]
