// Units of what is shown: lengths in millimetres or inches, angles in degrees or radians, speeds in rpm or 1/min. Numbers
// come with the unit in which they are, and are written once; what the reader writes into fields has the unit behind it.

import { store, stored } from "./store.js";

const KEY = "optlaws-units";
const INCH = 25.4;
const DEGREE = Math.PI / 180;

/** For each choice: the unit that takes the place of another, and what a number is multiplied by. */
const SWITCHED = {
  mm: { m: ["mm", 1000], "m/s": ["mm/s", 1000] },
  deg: { rad: ["deg", 1 / DEGREE], "rad/s": ["deg/s", 1 / DEGREE] },
  in: { m: ["in", 1000 / INCH], mm: ["in", 1 / INCH], "mm/s": ["in/s", 1 / INCH], "mm/s²": ["in/s²", 1 / INCH], "m/s": ["in/s", 1000 / INCH], "m/s²": ["in/s²", 1000 / INCH], "m/s³": ["in/s³", 1000 / INCH] },
  rad: { deg: ["rad", DEGREE], "deg/s": ["rad/s", DEGREE], "deg/s²": ["rad/s²", DEGREE], "deg/s³": ["rad/s³", DEGREE] },
  "1/min": { rpm: ["1/min", 1] },
};
export const CHOICES = { length: ["mm", "in"], angle: ["deg", "rad"], speed: ["rpm", "1/min"] };

function read() {
  try {
    return JSON.parse(stored(KEY)) ?? {};
  } catch {
    return {};
  }
}

/** The choices that are made: one of each of `CHOICES`. */
export function chosen() {
  const kept = read();
  return Object.fromEntries(Object.entries(CHOICES).map(([name, all]) => [name, all.includes(kept[name]) ? kept[name] : all[0]]));
}

/** Whether the browser keeps a choice. */
export function choose(name, unit) {
  return store(KEY, JSON.stringify({ ...chosen(), [name]: unit }));
}

const table = Object.assign({}, ...Object.values(chosen()).map((unit) => SWITCHED[unit] ?? {}));
for (const above of ["mm", "deg"]) {
  ["", "²", "³"].forEach((power, i) => { // of derivatives by the master
    const [one, other] = [shownUnit(above), shownUnit("deg")];
    table[`${above}/deg${power}`] = [`${one.unit}/${other.unit}${power}`, one.factor / other.factor ** (i + 1)];
  });
}

/** The unit that is shown for one, and by how much its numbers are multiplied. */
export function shownUnit(unit) {
  const [name, factor] = table[unit] ?? [unit, 1];
  return { unit: name, factor };
}

/** A name with the unit that is shown, "velocity, mm/s". */
export function headed(name, unit) {
  return unit ? `${name}, ${shownUnit(unit).unit}` : name;
}

/** The name of what pictures are over, with its unit: "master, deg (300 ms a turn)". */
export const variableOf = ({ across, unit, note = "" }) => `${headed(across, unit)}${note}`;

/** A number as text in the unit that is shown for its own, to so many digits. */
export function number(value, unit = "", digits = 6) {
  if (!Number.isFinite(value)) return "∞";
  const shown = value * shownUnit(unit).factor;
  const [mantissa, power] = shown.toExponential(digits - 1).split("e").map(Number);
  const plainly = power >= -5 && power < Math.max(digits, 6);
  return (plainly ? String(Number(shown.toPrecision(digits))) : `${mantissa}e${power}`).replaceAll("-", "−");
}

/** What the server says: a text, a quantity {value, unit, digits}, or a list of texts and quantities. */
export function written(said) {
  if (Array.isArray(said)) return said.map(written).join("");
  return said !== null && typeof said === "object" ? `${number(said.value, said.unit, said.digits)} ${shownUnit(said.unit).unit}` : said;
}

/** Sentences of the server in a line. */
export const listed = (sentences) => sentences.map(written).join(" · ");

/** Panels of curves in the units that are chosen. */
export function panelsInUnits(answer) {
  if (!answer?.panels) return answer;
  return { ...answer, panels: answer.panels.map(panelInUnits) };
}

function panelInUnits(panel) {
  const { unit, factor } = shownUnit(panel.unit);
  if (factor === 1) return { ...panel, unit };
  const times = (value) => (value === null || value === undefined ? value : value * factor);
  return {
    ...panel, unit,
    series: panel.series.map((one) => ({ ...one, values: one.values.map(times) })),
    limits: panel.limits?.map((limit) => ({ ...limit, value: times(limit.value), ...("least" in limit && { least: times(limit.least) }) })),
    peaks: panel.peaks?.map((peak) => ({ ...peak, value: peak.value * factor })),
    ends: panel.ends?.map(times),
  };
}

/** A number of a field with a decimal point, where it was written with a comma; a list has blanks behind its commas. */
export const plain = (text) => (text.includes("(") ? text : text.replace(/(\d),(\d)/g, "$1.$2").replace(/^,(\d)/, "0.$1"));
