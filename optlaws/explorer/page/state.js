// The study: all that the page shows follows from it, the address holds it, and every step can be undone.

import { minimise } from "./asked.js";
import { PARTS, VIEWS, object, same } from "./views.js";

const MERGED = 800; // ms within which changes of one thing are one step; those of one press of the pointer always are
const MOST = 200;
const WRITTEN = 120; // ms after the last change the address holds it

const press = { down: false, count: 0 };
globalThis.addEventListener?.("pointerdown", () => Object.assign(press, { down: true, count: press.count + 1 }), true);
for (const end of ["pointerup", "pointercancel"]) globalThis.addEventListener?.(end, () => (press.down = false));

export const FIRST = {
  name: "",
  notes: "",
  view: "laws",
  laws: [{ problem: { order: 4, degree: 9, B: 1.7 } }],
  active: 0,
  picture: "B-C",
  axis: 0,
  plane: 0,
  frequency: 20,
  damping: 0,
};

/** Whether the page can show a law. */
function lawful(law) {
  const { minimise = "", bounds = {} } = law?.problem ?? {};
  return object(law) && object(law.problem ?? {}) && typeof minimise === "string" && object(bounds);
}

/** What a link may hold, and whether the page can show it; the server says what else is wrong with it. */
const pair = (value) => Array.isArray(value) && value.length === 2 && value.every(Number.isFinite);
const spectrum = (value) => object(value) && Array.isArray(value.raw) && value.raw.length > 1 && value.raw.every(pair);
const WHOLE = { controller: object, band: pair, spectrum, ...Object.fromEntries(Object.entries(PARTS).map(([name, { whole }]) => [name, whole])) };
const KNOWN = ["name", "notes", "view", "active", "picture", "machinePicture", "move", "time", "axis", "plane", "frequency", "damping", "cycle", "axes", ...Object.keys(WHOLE)];

/** What differs from the first state, as an address's fragment. */
export function written(state) {
  const parts = new URLSearchParams();
  for (const [name, value] of Object.entries(state)) {
    if (name !== "laws" && !same(value, FIRST[name])) parts.set(name, JSON.stringify(value));
  }
  for (const law of state.laws) parts.append("law", JSON.stringify(law));
  return `#${parts}`;
}

/** A law of earlier versions, whose objective was a table of weights. */
function asNow({ weights, ...law }) {
  if (object(law.problem) && object(weights)) minimise(law, weights);
  return law;
}

/** Studies of version 1.0 had a machine for each of its views: the one that was shown is the machine. */
function oneMachine({ cycle, axes, ...state }) {
  const moves = object(state.fastest) && !("axis" in state.fastest);
  const machine = { cycle, axes, fastest: moves ? undefined : state.fastest }[state.view] ?? state.machine ?? cycle ?? axes;
  const { fastest, machine: _, ...others } = state;
  return { ...others, ...(moves && { fastest }), ...(machine && { machine }) };
}

/** The state of a fragment; what is not there is as at first, what cannot be read is left out. */
export function read(fragment) {
  const parts = new URLSearchParams(fragment.replace(/^#/, ""));
  let state = structuredClone(FIRST);
  const parsed = (text) => {
    try {
      return JSON.parse(text);
    } catch {
      return undefined;
    }
  };
  const laws = parts.getAll("law").map(parsed).filter(lawful).slice(0, 4);
  if (laws.length) state.laws = laws.map(asNow);
  for (const [name, text] of parts) {
    const value = parsed(text);
    if (KNOWN.includes(name) && value !== undefined && value !== null) state[name] = value;
  }
  state = oneMachine(state);
  if (!Number.isInteger(state.active) || state.active < 0 || state.active >= state.laws.length) state.active = 0;
  for (const name of ["frequency", "damping", "axis", "plane"]) if (typeof state[name] !== "number") state[name] = FIRST[name];
  for (const name of ["name", "notes", "view", "picture"]) if (typeof state[name] !== "string") state[name] = FIRST[name];
  for (const [name, whole] of Object.entries(WHOLE)) if (name in state && !whole(state[name])) delete state[name];
  if (!state.machine?.axis[state.axis]) state.axis = 0;
  return state;
}

/** A state of a file with all that the page can show; an error names what it cannot. */
export function whole(state, file) {
  if (!object(state) || !Array.isArray(state.laws ?? [])) throw new Error(`${file} holds no study: open a document that this page saved`);
  const given = { ...structuredClone(FIRST), ...state };
  const found = read(written(given));
  const name = Object.keys(WHOLE).find((one) => one in given && !(one in found));
  if (name) throw new Error(`${file}: ${VIEWS[given.view]?.title ?? name} needs ${PARTS[name]?.needs ?? "what the page wrote"}`);
  if (given.laws.length && !given.laws.every(lawful)) throw new Error(`${file}: a law needs a problem, a name or its pieces`);
  return found;
}

/** `changed(state)` draws a state; `kept(address)` keeps it, without the examples of other views that nobody changed. */
export function createStudy(state, changed, kept, examples) {
  let past = [];
  let future = [];
  let last = { what: null, at: 0 };
  let writing = null;

  /** Write the address now. */
  function keep() {
    if (writing === null) return;
    clearTimeout(writing);
    writing = null;
    const known = (part) => Object.entries(examples).filter(([view]) => VIEWS[view]?.part === part).map(([, value]) => value);
    const shown = VIEWS[state.view]?.part;
    const own = Object.entries(state).filter(([name, value]) => name === shown || !known(name).some((one) => same(value, one)));
    const address = written(Object.fromEntries(own));
    history.replaceState(null, "", address);
    kept(address);
  }

  /** Change a copy of the state; changes of the same thing in a row are one step. */
  function change(what, alter) {
    const next = structuredClone(state);
    alter(next);
    if (same(state, next)) return;
    const now = performance.now();
    const dragged = press.down && last.press === press.count;
    const merged = what === last.what && (dragged || now - last.at < MERGED) && past.length > 0;
    if (!merged) past = [...past, state].slice(-MOST);
    last = { what, at: now, press: press.count };
    future = [];
    show(next);
  }

  /** Look at another part of the state: that is no step. */
  function look(alter) {
    const next = structuredClone(state);
    alter(next);
    show(next);
  }

  /** Take a step from one list of states to the other. */
  function step(from, to) {
    if (!from.length) return;
    to.push(state);
    rest();
    show(from.pop());
  }

  /** The next change is a step of its own. */
  function rest() {
    last = { what: null, at: 0 };
  }

  function show(next) {
    state = next;
    // browsers take a few addresses a second, a drag makes more
    clearTimeout(writing);
    writing = setTimeout(keep, WRITTEN);
    changed(state);
  }

  return {
    get state() { return state; }, get canUndo() { return past.length > 0; }, get canRedo() { return future.length > 0; },
    change, look, keep, rest, undo: () => step(past, future), redo: () => step(future, past),
  };
}
