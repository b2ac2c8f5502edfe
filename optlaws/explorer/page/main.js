// The page: state in, views out.

import { CamView } from "./cam.js";
import { CycleView } from "./cycle.js";
import { Exporting } from "./exporting.js";
import { tabs } from "./fields.js";
import { Laws } from "./laws.js";
import { FIRST, Study, read } from "./state.js";
import { restore } from "./theme.js";
import { Tools } from "./tools.js";

const VIEWS = { laws: "Laws", cycle: "Cycle", cam: "Cam" };

restore();

function notice(text) {
  const root = document.getElementById("notice");
  root.textContent = text;
  root.hidden = !text;
}

function failed(error) {
  const gone = error instanceof TypeError;
  notice(gone ? "The server does not answer: start `optlaws explore` again; the address keeps the study." : error.message);
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
    notice("");
    const view = VIEWS[now.view] ? now.view : "laws";
    for (const name of Object.keys(VIEWS)) document.getElementById(`${name}-view`).hidden = name !== view;
    choose(view);
    tools.show(study);
    views[view].show(now);
    exporting.show(now);
  }

  views.laws = new Laws(study, names, failed, painted);
  views.cycle = new CycleView(study, failed);
  views.cam = new CamView(study, failed, followers);
  if (first.view in examples) first[first.view] ??= structuredClone(examples[first.view]);
  addEventListener("hashchange", () => study.replace(read(location.hash)));
  for (const kind of ["input", "pointermove", "keydown"]) addEventListener(kind, () => marked("input"), { capture: true, passive: true });
  render(first);
}

begin().catch(failed);
