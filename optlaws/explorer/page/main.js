// The page: state in, views out.

import { begun, createDetails, keep } from "./document.js";
import { createExporting } from "./exporting.js";
import { createOpening, fileOf } from "./files.js";
import { during, observe, reached } from "./latest.js";
import { tabs } from "./layout.js";
import { createMachineForms } from "./machine_forms.js";
import { createStudy, read } from "./state.js";
import { restore } from "./store.js";
import { button, html } from "./svg.js";
import { createTools } from "./tools.js";
import { VIEWS } from "./views.js";

restore();

function fill(name, ...parts) {
  const root = document.getElementById(name);
  root.replaceChildren(...parts);
  root.hidden = !parts[0];
}

const notice = (...parts) => fill("notice", ...parts);

const FULL = "The store of this browser is full: it keeps no change. The address holds the study; Save writes a document, and Notes deletes those of an earlier version.";
let full = false;

/** Keep an address; that the browser cannot is said once. */
function kept(address) {
  const before = full;
  full = !keep(address);
  if (full && !before) notice(FULL);
}

const LATER = 2000; // ms after the start: what checks proofs is there when the server is away

/** What takes long, by the path of its question. */
const LONG = {
  "api/laws": "optimal laws and their bounds",
  "api/front": "the front",
  "api/cycle": "optimal laws and their bounds",
  "api/machine": "optimal laws and their bounds",
  "api/machine-limits": "what no law can beat in each move",
  "api/machine-ratios": "optimal laws at other ratios",
  "api/fastest": "the least time and its bound",
  "api/fastest-front": "laws of longer times",
  "api/old-move": "a better law near the old one",
};

let ticking = null;

/** What is computed for long, and for how many seconds. */
function computing(slow) {
  const names = [...new Set(slow.map(({ path }) => LONG[path]).filter(Boolean))];
  const seconds = html("span", { "aria-hidden": "true" });
  const tick = () => (seconds.textContent = `${Math.round((performance.now() - Math.min(...slow.map(({ since }) => since))) / 1000)} s`);
  tick();
  ticking = setInterval(tick, 1000);
  return [" ", ...names.flatMap((name) => [html("span", { text: name }), " · "]), seconds];
}

/** What the server is at, where the reader should know: it is away, it computes for long, it had too little time. It stands
    beside the tools: what comes and goes amid a drag must not move the page. */
function work({ lost, slow, late }) {
  const say = (words, ...buttons) => fill("work", html("span", {}, ...words), ...buttons);
  clearInterval(ticking);
  if (lost) say(["The server does not answer. This page keeps the study, and goes on as soon as `optlaws explore` runs again."]);
  else if (slow.length) say(["Computing …", ...computing(slow)], button("Stop", () => slow.forEach((one) => one.stop())));
  else if (late.length) say(["This is not computed within 4 s."], button("Go on for 2 minutes", () => late.forEach((one) => one.goOn())));
  else fill("work");
  document.getElementById("work").classList.toggle("lost", lost);
}

/** Machines that a first visit can begin with, by the tabs that show them. */
const MACHINES = { cycle: "a servo slide", machine: "a crank press", axes: "a table and a die" };

/** When something happened last. */
function marked(name) {
  performance.clearMarks(name);
  performance.mark(name);
}

/** The time from an input to the paint that follows its answer, for benchmarks. */
function painted() {
  requestAnimationFrame(() => {
    const channel = new MessageChannel();
    channel.port1.onmessage = () => marked("painted");
    channel.port2.postMessage(null);
  });
}

async function open() {
  const { view } = read(location.hash);
  if (Object.hasOwn(VIEWS, view)) VIEWS[view].load().catch(() => {}); // on its way while the start is
  const start = await fetch("api/start").then((response) => response.json());
  const { state, examples, formats, names } = start;
  document.body.append(html("datalist", { id: "names" }, ...names.map((name) => html("option", { value: name }))));
  const first = begun(location.hash, state);
  const views = {};
  const roots = Object.fromEntries(Object.keys(VIEWS).map((name) => [name, html("main", { id: `${name}-view`, class: "view", hidden: true })]));
  document.getElementById("notice").after(...Object.values(roots));
  const study = createStudy(first, render, kept, examples);
  /** A part of the study that is not there yet begins with an example for the view that shows it. */
  const begin = (state, view) => {
    const { part } = VIEWS[view];
    if (part) state[part] ??= structuredClone(examples[view] ?? examples.cycle);
  };
  const named = (now) => (Object.hasOwn(VIEWS, now.view) ? now.view : "laws");
  const titles = Object.fromEntries(Object.entries(VIEWS).map(([name, { title }]) => [name, title]));
  const choose = tabs(document.getElementById("views"), titles, (key) => study.look((next) => {
    next.view = key;
    begin(next, key);
  }));
  const shown = () => views[named(study.state)];
  const exporting = createExporting(study, formats, (now) => (shown()?.moves ? { view: named(now), request: shown().request(now) } : null));
  const opened = (next) => {
    study.rest();
    study.change("open", (state) => {
      for (const name of Object.keys(state)) delete state[name];
      Object.assign(state, next);
    });
    study.rest();
  };
  const opening = createOpening(opened, notice, shown, (name, text) => during(show(name, text)).catch((error) => notice(error.message)));
  const details = createDetails(study);
  const forms = createMachineForms(study, start);
  const tools = createTools(document.getElementById("tools"), study, notice, { exporting, opening, details, shown });

  /** A view is loaded when it is first shown; one that fails to load is loaded when it is next shown. */
  async function load(name) {
    views[name] = null;
    const { createView } = await reached(VIEWS[name].load).catch((error) => {
      delete views[name];
      throw error;
    });
    views[name] = createView(roots[name], study, start, painted);
    render(study.state); // its questions begin before this work ends
  }

  function render(now) {
    const name = named(now);
    for (const [other, root] of Object.entries(roots)) root.hidden = other !== name;
    choose(name);
    // a law that is taken to another view takes the reader with it
    if (document.activeElement.closest(".view[hidden]")) document.querySelector(`#views [data-key=${name}]`).focus({ preventScroll: true });
    const view = views[name];
    if (VIEWS[name].part === "machine") {
      begin(now, name);
      forms.show(now, name, roots[name], view?.form);
    }
    if (view) {
      begin(now, name);
      view.show(now);
      exporting.show(now);
    } else if (view === undefined) during(load(name)).catch((error) => notice(error.message));
    document.getElementById("first").hidden = study.canUndo || location.hash.length > 1 || name !== "laws";
    tools.show(Boolean(view?.moves));
    details.show(now);
  }

  /** The proof of a file is checked by the second checker, which shares no code with the library. */
  async function show(name, text) {
    (await VIEWS.proof.load()).prove(name, text);
    notice("");
    if (study.state.view === "proof") render(study.state);
    study.look((next) => (next.view = "proof"));
  }

  /** So is the proof of what is shown. */
  async function prove() {
    const { name, text } = await fileOf("proof", shown(), study.state);
    await show(name, text);
  }

  for (const [view, text] of Object.entries(MACHINES)) {
    document.getElementById("first").append(button(text, () => study.change("begin", (next) => Object.assign(next, { view, machine: structuredClone(examples[view]) }))));
  }
  observe(work);
  addEventListener("prove", () => during(prove()).catch((error) => notice(error.message)));
  setTimeout(() => VIEWS.proof.load().catch(() => {}), LATER);
  document.querySelector(".skip").addEventListener("click", (event) => {
    event.preventDefault();
    const shown = [".handle", ".panels", "[tabindex]"].flatMap((name) => [...document.querySelectorAll(`.view:not([hidden]) ${name}`)]);
    shown.find((one) => one.checkVisibility())?.focus();
  });
  addEventListener("hashchange", () => opened(read(location.hash)));
  for (const kind of ["input", "pointermove", "keydown"]) addEventListener(kind, () => marked("input"), { capture: true, passive: true });
  addEventListener("pagehide", () => study.keep());
  render(first);
}

open().catch((error) => notice(error instanceof TypeError ? "The server does not answer: start `optlaws explore` again; the address keeps the study." : error.message));
