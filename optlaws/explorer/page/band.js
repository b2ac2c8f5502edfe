// A band of frequencies in the picture of the residual: dragged, weighed by a measured spectrum, and a bound of the law.

import { slider } from "./form.js";
import { Latest } from "./latest.js";
import { createStrip } from "./panels.js";
import { button, html } from "./svg.js";
import { plain } from "./units.js";

const STEP = 0.1;
const WIDE = 0.1; // of the frequency, on either side, as a band begins
const BOUND = /^residual\(/;
const TIME = "0.1 s";
const LARGEST = 2_000_000;
const SHARE = 0.5; // of what is left now, as a bound begins

const numbers = (line) => {
  const comma = /[;\t]/.test(line);
  return line.split(comma ? /[;\t]/ : /[,\s]+/).map((part) => Number((comma ? part.replace(",", ".") : part).trim() || "x"));
};

/** Pairs of a frequency and an amplitude, and whether the heading says Hz. */
function measured(text) {
  const lines = text.split(/\r?\n/);
  const pairs = lines.map(numbers).filter((row) => row.length > 1 && row.slice(0, 2).every(Number.isFinite)).map(([at, size]) => [at, size]);
  return { pairs, hertz: lines.some((line) => /\bHz\b/i.test(line)) };
}

export function createBand(study) {
  const field = html("input", { type: "file", accept: ".csv,.txt,.tsv,.dat,.tab", hidden: true, "aria-label": "File of a measured spectrum" });
  const spectrumRow = html("div", { class: "spectrum", translate: "no" });
  let last = null;
  let name = "";
  let known = null;
  const strip = createStrip({ step: STEP, chosen: () => {}, moved: (i, at) => change("band", (state) => (state.band[i] = at)), rested: () => study.rest() });
  const toggle = button("band", () => change("band on", (state) => {
    if (state.band) delete state.band;
    else state.band = [1 - WIDE, 1 + WIDE].map((share) => Number((share * state.frequency).toPrecision(3)));
    if (!state.band && !state.spectrum) bind(state, null);
  }), { "aria-pressed": "false", title: "A band of frequencies that the follower may have" });
  const bound = slider({
    name: "in it ≤", title: "Greatest residual acceleration in the band", low: 0, high: 5, step: 0.01, off: true,
    changed: limit, rested: () => study.rest(),
  });
  field.addEventListener("change", () => field.files.length && read(field.files[0]).catch((error) => say(error.message)));
  const choose = button("spectrum …", () => {
    field.value = "";
    field.click();
  }, { title: "Weigh the band by a measured spectrum: frequency and amplitude in a file, which can be dropped here" });
  const duration = html("input", { type: "text", class: "short", maxlength: 40, "aria-label": "Duration of the motion, for frequencies in Hz" });
  duration.addEventListener("change", () => take(study.state.spectrum.raw, plain(duration.value.trim())));
  const asked = new Latest("api/spectrum", ({ seconds }, question) => taken(question, seconds), (error) => say(error.message));
  const elements = [html("div", { class: "band" }, toggle, choose, field, spectrumRow), bound.element];

  /** Change the follower; a bound that a law has in the band goes with it. */
  function change(what, alter) {
    study.change(what, (state) => {
      alter(state);
      if (state.laws.some((law) => boundOf(law) !== null)) bind(state);
    });
  }

  function question({ band, spectrum }) {
    return { ...(band && { band }), ...(spectrum && { spectrum: spectrum.raw, ...(spectrum.duration && { duration: spectrum.duration }) }) };
  }

  function show(state) {
    const { band, spectrum, laws, active } = state;
    toggle.setAttribute("aria-pressed", String(Boolean(band)));
    bound.element.hidden = !laws[active].problem || !(band || spectrum);
    bound.set(boundOf(laws[active]));
    const remove = () => change("spectrum", (next) => {
      delete next.spectrum;
      if (!next.band) bind(next, null);
    });
    const parts = spectrum ? [html("span", { text: spectrum.name ?? "" }), ...(spectrum.duration ? [html("label", {}, "in ", duration)] : []), button("×", remove, { class: "close", "aria-label": "Take the spectrum away" })] : [];
    if (JSON.stringify([spectrum?.name, spectrum?.duration]) !== last) spectrumRow.replaceChildren(...parts);
    last = JSON.stringify([spectrum?.name, spectrum?.duration]);
    if (spectrum?.duration && document.activeElement !== duration) duration.value = spectrum.duration;
  }

  /** What the residual is shown with: the ends of the band, its bound, and the spectrum below. */
  function picture(picture, answer, { laws, active }) {
    known = answer;
    const { band, weight } = answer;
    const bound = boundOf(laws[active]);
    if (!band) return picture;
    const [from, to] = picture.range;
    const [first, ...others] = picture.panels;
    const inside = weight.filter(([nu]) => nu >= band[0] && nu <= band[1]);
    const allowed = bound === null ? [] : weight.length ? [{ law: "limit", name: "allowed by the spectrum", at: inside.map(([nu]) => nu), values: inside.map(([, size]) => (size > 0 ? bound / size : null)) }] : [];
    const limits = bound === null || weight.length ? [] : [{ from: band[0], to: band[1], least: null, value: bound }];
    const measuredPanel = weight.length ? [{ name: "measured spectrum", unit: "amplitude", series: [{ at: weight.map(([nu]) => nu), values: weight.map(([, size]) => size) }] }] : [];
    return {
      ...picture,
      panels: [{ ...first, limits, series: [...first.series, ...allowed] }, ...others, ...measuredPanel],
      segments: [{ name: "below", at: [from, band[0]] }, { name: "band", at: band }, { name: "above", at: [band[1], to] }],
    };
  }

  function words({ band, laws, weight }) {
    if (!band) return "";
    const each = laws.map((law, i) => `${"ABCD"[i]} ${law?.band ? `${law.band.text} at ${law.band.at}` : "—"}`).join(", ");
    return `; greatest${weight.length ? ", weighed," : ""} in the band ${band.map((one) => Number(one.toPrecision(4))).join(" to ")}: ${each}`;
  }

  /** Read a file of a measured spectrum; says that it is taken. */
  async function read(file) {
    if (file.size > LARGEST) throw new Error(`${file.name} is larger than ${LARGEST / 1e6} MB`);
    const { pairs, hertz } = measured(await file.text());
    if (pairs.length < 2) throw new Error(`${file.name} has no lines of a frequency and an amplitude`);
    name = file.name.slice(-60);
    take(pairs, hertz ? study.state.controller?.time || TIME : null);
    return true;
  }

  function take(pairs, duration) {
    asked.ask({ laws: study.state.laws, spectrum: pairs, ...(duration && { duration }) });
  }

  function taken({ spectrum: pairs, duration }, seconds) {
    change("spectrum", (state) => {
      state.spectrum = { name: name || state.spectrum?.name, raw: pairs, ...(duration && { duration, seconds }) };
    });
  }

  function say(text) {
    last = null;
    spectrumRow.replaceChildren(html("span", { class: "over", text }));
  }

  function limit(value) {
    study.change("bound in the band", (state) => {
      const now = known?.laws?.[state.active]?.band?.value ?? 1;
      bind(state, value === undefined ? Number((SHARE * now).toPrecision(3)) : value, state.active);
    });
  }

  return { strip, elements, change, question, show, picture, words, read };
}

/** The bound of the residual that a law has, or null. */
function boundOf(law) {
  const name = Object.keys(law.problem?.bounds ?? {}).find((key) => BOUND.test(key));
  return name === undefined ? null : law.problem.bounds[name][1];
}

/** The duration of the motion by what an older document has: frequencies in Hz, and in radians in the motion. */
const secondsOf = ({ raw, pairs }) => pairs[0][0] / raw[0][0] / (2 * Math.PI);

/** Give laws the bound in the band as it stands: a value for one of them, else what each has; null takes it away. */
function bind(state, value, only) {
  const { band, spectrum, damping } = state;
  const within = [
    ...(spectrum ? [`spectrum='{${spectrum.raw.map(([at, size]) => `${at}: ${size}`).join(", ")}}'`] : []),
    ...(spectrum?.duration ? [`duration=${spectrum.seconds ?? secondsOf(spectrum)}`] : []),
    ...(band ? [`frequency=(${band.join(", ")})`] : []),
    ...(damping ? [`damping=${damping}`] : []),
  ].join(", ");
  state.laws.forEach((law, i) => {
    if (!law.problem || (only !== undefined && i !== only)) return;
    const most = value === undefined ? boundOf(law) : value;
    const bounds = Object.fromEntries(Object.entries(law.problem.bounds ?? {}).filter(([key]) => !BOUND.test(key)));
    if (most !== null) bounds[`residual(${within})`] = [0, most];
    if (Object.keys(bounds).length) law.problem.bounds = bounds;
    else delete law.problem.bounds;
  });
}
