// Laws and their derivatives as panels over k.

/** The curves of laws, one panel for each of a, b, c, d and j; or why there is nothing to draw. */
export function curvesOf(views, active) {
  const drawn = views.map((view, law) => ({ view, law })).filter(({ view }) => view?.panels);
  const own = views[active];
  if (!drawn.length && own?.refused) return { refused: own.refused };
  const unbounded = own?.constants?.some(({ name, value }) => name === "J" && value === null);
  const panels = (own?.panels ?? drawn[0]?.view.panels ?? []).map((panel, i) => ({
    ...panel,
    ...(own?.panels ? {} : { peaks: [], limits: [] }),
    series: drawn.flatMap(({ view, law }) => view.panels[i].series.map((one) => ({ ...one, law, name: view.title }))),
    span: panel.symbol === "a" ? [0, 1] : null,
    note: panel.symbol === "j" && unbounded ? "without bound: c jumps" : "",
  }));
  return { across: "dimensionless time k", symbol: "k", range: [0, 1], ticks: [0, 0.25, 0.5, 0.75, 1], active, panels };
}
