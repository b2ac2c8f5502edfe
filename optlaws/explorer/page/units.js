// Units of what is shown: lengths in millimetres or inches, angles in degrees or radians, speeds in rpm or 1/min. What
// the reader writes into fields has the unit that stands behind it.

const KEY = "optlaws-units";
const ATTRIBUTES = ["aria-label", "aria-valuetext", "title"];
const SKIPPED = "script, style, textarea, [translate=no]";
const INCH = 25.4;
const DEGREE = Math.PI / 180;

/** For each choice but the usual one: the unit that takes the place of another, and what a number is multiplied by. */
const SWITCHED = {
  in: { mm: ["in", 1 / INCH], "mm/s": ["in/s", 1 / INCH], "mm/s²": ["in/s²", 1 / INCH], "m/s": ["in/s", 1000 / INCH], "m/s²": ["in/s²", 1000 / INCH], "m/s³": ["in/s³", 1000 / INCH] },
  rad: { deg: ["rad", DEGREE], "deg/s": ["rad/s", DEGREE], "deg/s²": ["rad/s²", DEGREE], "deg/s³": ["rad/s³", DEGREE] },
  "1/min": { rpm: ["1/min", 1] },
};
export const CHOICES = { length: ["mm", "in"], angle: ["deg", "rad"], speed: ["rpm", "1/min"] };
const NUMBER = "[−-]?\\d+(?:\\.\\d+)?(?:e[−-]?\\d+)?";

function read() {
  try {
    return JSON.parse(localStorage.getItem(KEY)) ?? {};
  } catch {
    return {};
  }
}

/** The choices that are made: one of each of `CHOICES`. */
export function chosen() {
  const kept = read();
  return Object.fromEntries(Object.entries(CHOICES).map(([name, all]) => [name, all.includes(kept[name]) ? kept[name] : all[0]]));
}

export function choose(name, unit) {
  localStorage.setItem(KEY, JSON.stringify({ ...chosen(), [name]: unit }));
}

const table = Object.assign({}, ...Object.values(chosen()).map((unit) => SWITCHED[unit] ?? {}));
export const switching = Object.keys(table).length > 0;
const pattern = new RegExp(`(${NUMBER}(?: to ${NUMBER})?) (${Object.keys(table).sort((one, other) => other.length - one.length).map((unit) => unit.replace("/", "\\/")).join("|")})(?![\\w/²³^·])`, "g");

/** The unit that is shown for one, and by how much its numbers are multiplied. */
export function shownUnit(unit) {
  const [, above, below, power] = /^(mm|deg)\/(deg)([²³]?)$/.exec(unit) ?? []; // a derivative by the master
  if (above) {
    const [one, other] = [shownUnit(above), shownUnit(below)];
    return { unit: `${one.unit}/${other.unit}${power}`, factor: one.factor / other.factor ** { "": 1, "²": 2, "³": 3 }[power] };
  }
  const [name, factor] = table[unit] ?? [unit, 1];
  return { unit: name, factor };
}

/** A name with its unit, "velocity, m/s", and what turns texts of its numbers into the unit that is shown. */
export function measured(name, of = "") {
  const [, word, known] = of ? [null, name, of] : /^(.*), ([^,]+)$/.exec(name) ?? [null, name, ""];
  const { unit, factor } = shownUnit(known);
  return { title: unit ? `${word}, ${unit}` : word, shown: (text) => (text === null ? null : inUnit(text, factor)) };
}

/** A number as text in another unit, with as many digits as it had. */
export function inUnit(text, factor) {
  if (factor === 1) return text;
  const value = Number(text.replace("−", "-"));
  const digits = text.replace(/e.*$/, "").replace(/[^\d]/g, "").replace(/^0+/, "").length;
  return Number.isFinite(value) ? String(Number((value * factor).toPrecision(Math.max(4, digits)))).replace("-", "−") : text;
}

/** A text with its lengths, angles and speeds in the units that are chosen. */
export function inUnits(text) {
  if (!switching) return text;
  return text.replace(pattern, (_, numbers, unit) => {
    const [name, factor] = table[unit];
    return `${numbers.split(" to ").map((one) => inUnit(one, factor)).join(" to ")} ${name}`;
  });
}

/** Panels of curves in the units that are chosen. */
export function panelsInUnits(answer) {
  if (!switching || !answer?.panels) return answer;
  return { ...answer, panels: answer.panels.map(panelInUnits) };
}

function panelInUnits(panel) {
  const { unit, factor } = shownUnit(panel.unit);
  if (factor === 1) return { ...panel, unit };
  const times = (value) => (value === null || value === undefined ? value : value * factor);
  return {
    ...panel, unit,
    values: panel.values?.map(times),
    series: panel.series?.map((one) => ({ ...one, values: one.values.map(times) })),
    limits: panel.limits?.map((limit) => ({ ...limit, value: times(limit.value), ...("least" in limit && { least: times(limit.least) }) })),
    peaks: panel.peaks?.map((peak) => ({ ...peak, value: peak.value * factor, text: inUnit(peak.text, factor) })),
    ends: panel.ends?.map((end) => inUnit(end, factor)),
  };
}

/** A number of a field with a decimal point, where it was written with a comma; a list has blanks behind its commas. */
export const plain = (text) => (text.includes("(") ? text : text.replace(/(\d),(\d)/g, "$1.$2").replace(/^,(\d)/, "0.$1"));

const shown = new WeakMap(); // of text nodes and elements: what stands there, in the units that are chosen

/** Write everything on the page, now and later, in the units that are chosen. */
export function watchUnits() {
  if (!switching) return;
  new MutationObserver((changes) => {
    for (const { type, target, addedNodes, attributeName } of changes) {
      if (type === "attributes") attribute(target, attributeName);
      else if (type === "characterData") text(target);
      else addedNodes.forEach(all);
    }
  }).observe(document.documentElement, { subtree: true, childList: true, characterData: true, attributes: true, attributeFilter: ATTRIBUTES });
  all(document.documentElement);
}

function all(root) {
  if (root.nodeType === Node.TEXT_NODE) return text(root);
  if (root.nodeType !== Node.ELEMENT_NODE || root.closest(SKIPPED)) return;
  for (const name of ATTRIBUTES) if (root.hasAttribute(name)) attribute(root, name);
  root.childNodes.forEach(all);
}

function text(node) {
  if (node.parentElement?.closest(SKIPPED) || shown.get(node) === node.data) return;
  const converted = inUnits(node.data);
  shown.set(node, converted);
  if (converted !== node.data) node.data = converted;
}

function attribute(element, name) {
  const known = shown.get(element) ?? shown.set(element, {}).get(element);
  const value = element.getAttribute(name);
  if (value === null || known[name] === value || element.closest("[translate=no]")) return;
  known[name] = inUnits(value);
  if (known[name] !== value) element.setAttribute(name, known[name]);
}
