// The page: state in, views out.

import { CamView } from "./cam.js";
import { CycleView } from "./cycle.js";
import { Exporting } from "./exporting.js";
import { tabs } from "./fields.js";
import { observe } from "./latest.js";
import { Laws } from "./laws.js";
import { FIRST, Study, read } from "./state.js";
import { html } from "./svg.js";
import { restore } from "./theme.js";
import { Tools } from "./tools.js";

const VIEWS = { laws: "Laws", cycle: "Cycle", cam: "Cam" };

restore();

function notice(text, ...buttons) {
  const root = document.getElementById("notice");
  root.replaceChildren(text, ...buttons);
  root.hidden = !text;
}

let working = false;

/** What the server is at, where the reader should know: it is away, it computes for long, it had too little time. */
function work({ lost, slow, late }) {
  const button = (text, act) => html("button", { type: "button", text, onclick: act });
  if (lost) notice("The server does not answer. This page keeps the study, and goes on as soon as `optlaws explore` runs again.");
  else if (slow.length) notice("Computing …", button("Stop", () => slow.forEach((one) => one.stop())));
  else if (late.length) notice("This is not computed within 4 s.", button("Go on for 2 minutes", () => late.forEach((one) => one.goOn())));
  else if (working) notice("");
  working = lost || slow.length > 0 || late.length > 0;
}

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

async function begin() {
  const { state, names, cycle, cam, followers, formats } = await (await fetch("api/start")).json();
  const first = location.hash.length > 1 ? read(location.hash) : { ...structuredClone(FIRST), ...state };
  const views = {};
  const examples = { cycle, cam };
  const study = new Study(first, render);
  const choose = tabs(document.getElementById("views"), VIEWS, (key) => study.change("view", (next) => {
    next.view = key;
    if (key in examples) next[key] ??= structuredClone(examples[key]);
  }));
  const exporting = new Exporting(study, formats);
  const tools = new Tools(document.getElementById("tools"), study, notice, exporting);

  function render(now) {
    const view = Object.hasOwn(VIEWS, now.view) ? now.view : "laws";
    for (const name of Object.keys(VIEWS)) document.getElementById(`${name}-view`).hidden = name !== view;
    choose(view);
    tools.show(study);
    views[view].show(now);
    exporting.show(now);
  }

  observe(work);
  views.laws = new Laws(study, names, painted);
  views.cycle = new CycleView(study);
  views.cam = new CamView(study, followers);
  if (first.view in examples) first[first.view] ??= structuredClone(examples[first.view]);
  document.querySelector(".skip").addEventListener("click", (event) => {
    event.preventDefault();
    document.querySelector(".view:not([hidden]) :is(.handle, .picture, #motion)").focus();
  });
  addEventListener("hashchange", () => study.replace(read(location.hash)));
  for (const kind of ["input", "pointermove", "keydown"]) addEventListener(kind, () => marked("input"), { capture: true, passive: true });
  render(first);
}

begin().catch((error) => notice(error instanceof TypeError ? "The server does not answer: start `optlaws explore` again; the address keeps the study." : error.message));
