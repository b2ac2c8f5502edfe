// Laws and their derivatives as panels over k.

const CURVES = { a: "displacement", b: "velocity", c: "acceleration", d: "power", j: "jerk" };

/** The curves of laws, one panel for each of a, b, c, d and j; or why there is nothing to draw. */
export function curvesOf(views, active) {
  const drawn = views.map((view, law) => ({ view, law })).filter(({ view }) => view?.curves);
  const own = views[active];
  if (!drawn.length && own?.refused) return { refused: own.refused };
  const unbounded = own?.constants?.some(({ name, value }) => name === "J" && value === null);
  const panels = Object.entries(CURVES).map(([letter, name]) => ({
    name: `${name} ${letter}`,
    symbol: letter,
    series: drawn.map(({ view, law }) => ({ at: view.curves.k, values: view.curves[letter], law, name: view.title })),
    peaks: (own?.peaks?.[letter] ?? []).map(({ k, value }) => ({ at: k, value })),
    span: letter === "a" ? [0, 1] : null,
    note: letter === "j" && unbounded ? "without bound: c jumps" : "",
  }));
  return { across: "dimensionless time k", symbol: "k", range: [0, 1], ticks: [0, 0.25, 0.5, 0.75, 1], active, panels };
}
