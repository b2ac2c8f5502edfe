// The view of a cam: mechanism and motion on the left, the cam that turns, pressure angle and curvature on the right.

import { Form } from "../form.js";
import { Latest } from "../latest.js";
import { column, explained, group, growing, laidOut, part, picture, status } from "../layout.js";
import { Programme } from "../machine_forms.js";
import { Mechanism } from "../mechanism.js";
import { Panels } from "../panels.js";
import { showTrust } from "../report.js";
import { Run } from "../run.js";
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

export class View {
  files;
  drawings = "#cam-curves svg";
  #study;
  #form;
  #kinds;
  #programme;
  #at;
  #mechanism;
  #motion;
  #cams;
  #sizes;
  #loads;
  #answer = null;

  constructor(root, study, { cam, programme }) {
    this.#study = study;
    this.#at = laidOut(root,
      html("aside", { id: "mechanism", "aria-label": "The cam, its follower and its motion" }, part("cam-size"), part("cam-programme")),
      column("cam-middle", "The cam", status("cam-trust"), growing(picture("cam-drawing"), part("cam-turning"), html("p", { class: "facts", id: "cam-reading", role: "status" }))),
      html("section", { id: "cam-curves", class: "panel", "aria-label": "Displacement, pressure angle and curvature over the turn" }),
    );
    this.#mechanism = new Mechanism(this.#at.drawing);
    this.#motion = new Panels(this.#at.curves);
    this.#kinds = cam;
    const { choices } = named(named(cam.entries, "file").list.entries, "format");
    const cut = choices.map((format) => ({ kind: format, text: `Profile (${format})`, about: "The cam's edge, within 1 µm" }));
    this.files = ["problem", "table", ...cut];
    this.#form = new Form((what, alter) => study.change(what, (state) => alter(state.cam)), () => study.rest(), (one, _path, before) => this.#take(one, before));
    this.#programme = new Programme(this.#at.programme, study, (state) => state.cam, programme);
    this.#cams = new Latest("api/cam", (answer, question) => {
      this.#render(answer);
      if (answer.refused) return;
      if (question.study.motion?.drive) this.#loads.ask(question);
      this.#sizes.ask(question);
    });
    this.#loads = new Latest("api/cam-loads", (loads, asked) => same(asked.study, this.#study.state.cam) && this.#bear(loads), (error) => this.#bear({ panels: [], facts: [error.message] }));
    this.#sizes = new Latest("api/cam-sizes", ({ facts }, asked) => same(asked.study, this.#study.state.cam) && this.#fact(facts), (error) => this.#fact([error.message]));
    this.#turning(cam.entries);
    this.#motion.cursor.watch((at) => this.#turn(at));
  }

  /** The request to the server, of which files are made too. */
  request({ cam }) {
    return { study: cam };
  }

  show(state) {
    const axis = this.#kinds.axes[state.cam.follower?.kind] ?? "length";
    this.#form.draw(this.#at.size, axis, state.cam, () => this.#fields(axis));
    this.#programme.show(state);
    this.#cams.ask({ study: state.cam });
  }

  #render(answer) {
    showTrust(this.#at.trust, answer);
    if (!answer.refused) this.#fact(null);
    this.#answer = answer;
    this.#motion.show(answer);
    this.#mechanism.show(answer);
  }

  /** What is known of the sizes stands below the words of trust; until it is, the space is kept. */
  #fact(facts) {
    this.#at.trust.querySelector(".sizes")?.remove();
    this.#at.trust.append(html("p", { class: "facts sizes", text: facts ? listed(facts) : "…" }));
  }

  /** What the cam bears stands below its geometry. */
  #bear({ panels, facts, leaves = "" }) {
    for (const old of this.#at.trust.querySelectorAll(".loads")) old.remove();
    // a cam that its follower leaves is no good one, whatever can be cut
    if (leaves) this.#at.trust.querySelector("p")?.prepend(html("strong", { class: `word ${leaves.endsWith("off") ? "bad" : "warn"} loads`, text: leaves.replace("the follower ", "") }), " ");
    if (facts.length) this.#at.trust.querySelector(".sizes")?.before(html("p", { class: "facts loads", text: listed(facts) }));
    this.#mechanism.bear(panels.find(({ name }) => name === "contact force")?.series[0] ?? null);
    if (this.#answer && !this.#answer.refused) this.#motion.show({ ...this.#answer, panels: [...this.#answer.panels, ...panels] });
  }

  #fields(axis) {
    const { entries, drive } = this.#kinds;
    const [follower, forces, spring] = TABLES.map((name) => named(entries, name));
    const sizes = entries.filter(({ name }) => !ELSEWHERE.includes(name) && !TABLES.includes(name));
    return [
      group("Follower", ...this.#form.fields([follower])),
      group("Cam", ...this.#form.fields(sizes)),
      group("Forces", ...this.#form.fields(drive[axis], ["motion", "drive"]), ...this.#form.fields(forces.entries, ["forces"])),
      group("Spring", ...this.#form.fields([spring])),
    ];
  }

  /** A follower that swings in place of one that slides has another motion, and other forces. */
  #take(cam, before) {
    const axis = this.#kinds.axes[cam.follower.kind];
    if (axis === this.#kinds.axes[before?.kind]) return;
    for (const segment of cam.motion.segment) if (segment.by) segment.by = axis === "angle" ? "20 deg" : "35 mm";
    for (const name of ["limits", "drive"]) delete cam.motion[name];
    for (const name of ["forces", "spring"]) delete cam[name];
  }

  #turning(entries) {
    const measure = html("input", { type: "checkbox", checked: true, onchange: () => this.#mechanism.measure(measure.checked) });
    new Run(this.#at.turning, "Angle of the cam, degrees", this.#motion.cursor);
    this.#at.turning.append(html("label", { class: "switch" }, measure, "dimensions"));
    this.#at.reading.after(explained([...WORDS, ...entries.filter(({ name }) => !ELSEWHERE.includes(name)).map(({ label, about }) => [label, about])]));
  }

  /** The cam, and what is read of it, are where the cursor of the curves is. */
  #turn(at) {
    if (at === null) return;
    this.#mechanism.turn(at);
    this.#at.reading.textContent = [`at ${written({ value: Math.round(at), unit: "deg", digits: 6 })}`, ...this.#motion.readings].join(" · ");
  }
}
