// The language of the page: what it says in English is said in another one by the table of texts, wherever it stands; with
// the language's decimal sign, in what is shown and in what is written into fields.

import { inUnits, switching } from "./units.js";

const KEY = "optlaws-language";
export const LANGUAGES = { en: "English", de: "Deutsch", fr: "Français", uk: "Українська" };
const WITH_COMMA = ["de", "fr", "uk"];
const ATTRIBUTES = ["aria-label", "aria-valuetext", "title", "placeholder"];
const SKIPPED = "script, style, textarea, [translate=no]";
/** A decimal number; no member of a family as III(7.2), no file, no version. */
const DECIMAL = /(?<![\w.(])(\d+)\.(\d+)(?![\w.]*[A-Za-z(])(?!\.\d)/g;

/** The language of the page: the reader's choice, or the browser's. */
export function language() {
  let kept = null;
  try {
    kept = localStorage.getItem(KEY);
  } catch {
    // a browser that keeps nothing has its own language
  }
  const own = [kept, ...(navigator.languages ?? [])].map((one) => one?.slice(0, 2)).find((one) => one in LANGUAGES);
  return own ?? "en";
}

export function speak(name) {
  localStorage.setItem(KEY, name);
}

const comma = WITH_COMMA.includes(language());

/** A value of a field as it is written in the language. */
export const localised = (value) => (comma ? String(value).replace(DECIMAL, "$1,$2") : String(value));

/** What is written in a field, with the decimal sign of optlaws. */
export const plain = (text) => (comma ? text.replace(/(\d),(\d)/g, "$1.$2").replace(/^,(\d)/, "0.$1") : text);

const LONGEST = 160;
const DEEPEST = 2;

/** What the table lacks, as far as it was to be said. */
export const missed = new Set();

let texts = null;
const sources = new WeakMap(); // of text nodes and elements: what was said in English, and in the language
const patterns = [];

/** Say everything of the page, now and later, in its language and units. */
export async function translate() {
  const name = language();
  document.documentElement.lang = name;
  if (name === "en" && !switching) return;
  if (name !== "en") {
    const { TEXTS } = await import("./texts.js");
    const place = WITH_COMMA.indexOf(name);
    texts = new Map(Object.entries(TEXTS).map(([english, others]) => [english, others[place]]));
    for (const [english, said] of texts) {
      const places = english.match(/\{\*?\}/g);
      if (places) patterns.push({ pattern: new RegExp(`^${english.split(/\{\*?\}/).map(escaped).join("(.+?)")}$`), said, any: places.map((one) => one === "{*}") });
    }
  }
  new MutationObserver((changes) => {
    for (const { type, target, addedNodes, attributeName } of changes) {
      if (type === "attributes") attribute(target, attributeName);
      else if (type === "characterData") text(target);
      else addedNodes.forEach(all);
    }
  }).observe(document.documentElement, { subtree: true, childList: true, characterData: true, attributes: true, attributeFilter: ATTRIBUTES });
  all(document.documentElement);
}

const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

function all(root) {
  if (root.nodeType === Node.TEXT_NODE) return text(root);
  if (root.nodeType !== Node.ELEMENT_NODE || root.closest(SKIPPED)) return;
  for (const name of ATTRIBUTES) if (root.hasAttribute(name)) attribute(root, name);
  root.childNodes.forEach(all);
}

function text(node) {
  if (!/\S/.test(node.data) || node.parentElement?.closest(SKIPPED)) return;
  if (sources.get(node) === node.data) return;
  const said = say(node.data);
  sources.set(node, said);
  if (said !== node.data) node.data = said;
}

function attribute(element, name) {
  const known = sources.get(element) ?? sources.set(element, {}).get(element);
  const value = element.getAttribute(name);
  if (value === null || known[name] === value || element.closest("[translate=no]")) return;
  known[name] = say(value, name === "placeholder"); // an example is in the unit that it is of
  if (known[name] !== value) element.setAttribute(name, known[name]);
}

/** A text in the language and the units of the page. */
export function say(english, asIs = false) {
  const [, before, core, after] = /^(\s*)([^]*?)(\s*)$/.exec(english);
  const spoken = texts === null ? core : translated(core);
  const said = asIs ? spoken : inUnits(spoken);
  return before + (comma ? said.replace(DECIMAL, "$1,$2") : said) + after;
}

/** Whether a text is said in the language of the page: all of it is in the table. */
export const known = (english) => texts === null || neutral(english) || found(english) !== null;

/** What needs no translation: numbers, units, symbols. */
const neutral = (text) => !/\p{L}{4,}/u.test(text.replace(/\b(?:deg|rad|rpm|min|rms|mm|ms)\b/g, ""));

/** A text in the language; null where the table has none. */
function found(english, depth = 0) {
  const exact = texts.get(english);
  if (exact !== undefined) return exact;
  if (english.includes(" · ")) return english.split(" · ").map(translated).join(" · ");
  // sentences of the server that are longer, or nested deeper, are not in the table
  if (english.length > LONGEST || depth > DEEPEST) return null;
  for (const { pattern, said, any } of patterns) {
    const parts = pattern.exec(english)?.slice(1);
    const others = parts?.map((part, i) => (any[i] ? part : found(part, depth + 1) ?? (neutral(part) ? part : null)));
    if (!others || others.includes(null)) continue;
    let i = 0;
    return said.replace(/\{\*?(\d?)\}/g, (_, place) => others[place ? Number(place) - 1 : i++]);
  }
  const head = /^([^,:]+)([,:] )(.+)$/.exec(english); // a name with its unit, or words one after another
  const known = head && (texts.get(head[1]) ?? (neutral(head[1]) ? head[1] : null));
  const rest = known && (found(head[3], depth + 1) ?? (neutral(head[3]) ? head[3] : null));
  return rest ? known + head[2] + rest : null;
}

function translated(english) {
  const said = found(english);
  if (said === null && !neutral(english) && missed.size < 1000) missed.add(english);
  return said ?? english;
}
