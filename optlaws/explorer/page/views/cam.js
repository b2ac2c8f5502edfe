// The view of a cam: mechanism and motion on the left, the cam that turns, pressure angle and curvature on the right.

import { createForm } from "../form.js";
import { Latest } from "../latest.js";
import { column, explained, group, growing, laidOut, part, picture, status } from "../layout.js";
import { createProgramme } from "../machine_forms.js";
import { createMechanism } from "../mechanism.js";
import { createPanels, createRun } from "../panels.js";
import { showTrust, table } from "../report.js";
import { html } from "../svg.js";
import { listed, written } from "../units.js";
import { same } from "../views.js";

/** Entries of the file that the page has elsewhere, or does not show. */
const ELSEWHERE = ["title", "text", "motion", "speed", "period", "rows", "best", "pair", "process", "as_made", "file", "animation"];
const TABLES = ["follower", "forces", "spring"];
const named = (entries, name) => entries.find((entry) => entry.name === name);
const WORDS = [
  ["base circle", "the smallest circle that touches the profile: the prime circle less the radius of the roller"],
  ["undercut", "the profile crosses itself or has a cusp: no such cam can be cut"],
];

export function createView(root, study, { cam, programme }) {
  let current = null;
  const elements = laidOut(root,
    html("aside", { id: "mechanism", "aria-label": "The cam, its follower and its motion" }, part("cam-size"), part("cam-programme")),
    column("cam-middle", "The cam", status("cam-trust"), growing(picture("cam-drawing"), part("cam-turning"), html("p", { class: "facts", id: "cam-reading", role: "status" }))),
    html("section", { id: "cam-curves", class: "panel", "aria-label": "Displacement, pressure angle and curvature over the turn" }),
  );
  const mechanism = createMechanism(elements.drawing);
  const motion = createPanels(elements.curves);
  const kinds = cam;
  const { choices } = named(named(cam.entries, "file").list.entries, "format");
  const cut = choices.map((format) => ({ kind: format, text: `Profile (${format})`, about: "The cam's edge, within 1 µm" }));
  const files = ["problem", "table", ...cut];
  const form = createForm((what, alter) => study.change(what, (state) => alter(state.cam)), () => study.rest(), (one, _path, before) => take(one, before));
  const programmeForm = createProgramme(elements.programme, study, (state) => state.cam, programme);
  const cams = new Latest("api/cam", (answer, question) => {
    render(answer);
    if (answer.refused) return;
    if (question.study.motion?.drive) loads.ask(question);
    sizes.ask(question);
  });
  const loads = new Latest("api/cam-loads", (loads, asked) => same(asked.study, study.state.cam) && bear(loads), (error) => bear({ panels: [], facts: [error.message] }));
  const sizes = new Latest("api/cam-sizes", ({ facts, beside }, asked) => same(asked.study, study.state.cam) && fact(facts, beside), (error) => fact([error.message]));
  turning(cam.entries);
  motion.cursor.watch(turn);

  /** The request to the server, of which files are made too. */
  function request({ cam }) {
    return { study: cam };
  }

  function show(state) {
    const axis = kinds.axes[state.cam.follower?.kind] ?? "length";
    form.draw(elements.size, axis, state.cam, () => fields(axis));
    programmeForm.show(state);
    cams.ask({ study: state.cam });
  }

  function render(answer) {
    showTrust(elements.trust, answer);
    if (!answer.refused) fact(null);
    current = answer;
    motion.show(answer);
    mechanism.show(answer);
  }

  /** What is known of the sizes stands below the words of trust, and how they compare; until it is, the space is kept. */
  function fact(facts, beside = null) {
    for (const old of elements.trust.querySelectorAll(".sizes")) old.remove();
    elements.trust.append(html("p", { class: "facts sizes", text: facts ? listed(facts) : "…" }));
    if (beside) elements.trust.append(table("Peaks and sizes", beside.headings, beside.rows, { class: "sizes" }));
  }

  /** What the cam bears stands below its geometry. */
  function bear({ panels, facts, leaves = "" }) {
    for (const old of elements.trust.querySelectorAll(".loads")) old.remove();
    // a cam that its follower leaves is no good one, whatever can be cut
    if (leaves) elements.trust.querySelector("p")?.prepend(html("strong", { class: `word ${leaves.endsWith("off") ? "bad" : "warn"} loads`, text: leaves.replace("the follower ", "") }), " ");
    if (facts.length) elements.trust.querySelector(".sizes")?.before(html("p", { class: "facts loads", text: listed(facts) }));
    mechanism.bear(panels.find(({ name }) => name === "contact force")?.series[0] ?? null);
    if (current && !current.refused) motion.show({ ...current, panels: [...current.panels, ...panels] });
  }

  function fields(axis) {
    const { entries } = kinds;
    const [follower, forces, spring] = TABLES.map((name) => named(entries, name));
    const sizes = entries.filter(({ name }) => !ELSEWHERE.includes(name) && !TABLES.includes(name));
    return [
      group("Follower", ...form.fields([follower])),
      group("Cam", ...form.fields(sizes)),
      group("Forces", ...form.fields(programme.drive[axis], ["motion", "drive"]), ...form.fields(forces.entries, ["forces"])),
      group("Spring", ...form.fields([spring])),
    ];
  }

  /** A follower that swings in place of one that slides has another motion, and other forces. */
  function take(cam, before) {
    const axis = kinds.axes[cam.follower.kind];
    if (axis === kinds.axes[before?.kind]) return;
    for (const segment of cam.motion.segment) if (segment.by) segment.by = axis === "angle" ? "12 deg" : "35 mm";
    for (const name of ["limits", "drive"]) delete cam.motion[name];
    for (const name of ["forces", "spring"]) delete cam[name];
  }

  function turning(entries) {
    const measure = html("input", { type: "checkbox", checked: true, onchange: () => mechanism.measure(measure.checked) });
    createRun(elements.turning, "Angle of the cam, degrees", motion.cursor);
    elements.turning.append(html("label", { class: "switch" }, measure, "dimensions"));
    elements.reading.after(explained([...WORDS, ...entries.filter(({ name }) => !ELSEWHERE.includes(name)).map(({ label, about }) => [label, about])]));
  }

  /** The cam, and what is read of it, are where the cursor of the curves is. */
  function turn(at) {
    if (at === null) return;
    mechanism.at(at);
    elements.reading.textContent = [`at ${written({ value: Math.round(at), unit: "deg", digits: 6 })}`, ...motion.readings].join(" · ");
  }

  return { files, drawings: "#cam-curves svg", request, show };
}
