"""The fastest move within limits
==============================

Accelerations from -8 to 12 m/s² and a jerk of 300 m/s³: the fastest polynomial takes 1.6 % more than seven segments.
"""

import matplotlib.pyplot as plt

from optlaws import Pieces, Problem, fastest

limits = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}
smooth = fastest(Problem(order=3), stroke="100 mm", limits=limits)
segments = Problem(order=3, basis=Pieces(smooth.limit_breaks, degree=3, continuity=2), symmetric=False)
moves = {"polynomial": smooth, "seven segments": fastest(segments, stroke="100 mm", limits=limits)}
k = [i / 1000 for i in range(1001)]
for name, move in moves.items():
    acceleration = move.stroke / move.duration**2 * move.law(k, 2)
    plt.plot([1e3 * move.duration * place for place in k], acceleration, label=f"{name}: {1e3 * move.duration:.1f} ms")
for limit in (-8, 12):
    plt.axhline(limit, linestyle=":")
plt.gca().set(xlabel="time, ms", ylabel="acceleration, m/s²")
plt.legend()
