// The view of a cam: mechanism and motion on the left, the cam that turns, pressure angle and curvature on the right.

import { group } from "./fields.js";
import { Latest } from "./latest.js";
import { Mechanism } from "./mechanism.js";
import { Motion } from "./motion.js";
import { Programme } from "./programme.js";
import { html } from "./svg.js";
import { showTrust } from "./trust.js";

const told = (value) => JSON.stringify(value);
const element = (id) => document.getElementById(id);
const FIELDS = {
  "translating roller": { radius: "12 mm", offset: "0 mm" },
  "translating flat": {},
  "oscillating roller": { radius: "14 mm", arm: "110 mm", pivot_distance: "140 mm" },
  "oscillating flat": { pivot_distance: "120 mm", face_offset: "0 mm" },
};
const SIZES = { base_radius: "60 mm", cutter_radius: "none", pressure_angle: "none, or 30 deg", radius_of_curvature: "none, or 15 mm" };
const NAMES = { base_radius: "base circle", cutter_radius: "cutter", pressure_angle: "pressure ≤", radius_of_curvature: "radius ≥", pivot_distance: "pivot", face_offset: "offset" };
const SPEED = 60; // degrees a second

export class CamView {
  #study;
  #programme;
  #mechanism = new Mechanism(element("cam-drawing"));
  #motion = new Motion(element("cam-curves"));
  #cams;
  #sizes;
  #kind = "";
  #shows = [];
  #playing = null;
  #dial;
  #play;

  constructor(study, failed) {
    this.#study = study;
    this.#programme = new Programme(element("cam-programme"), study, (state) => state.cam);
    this.#cams = new Latest("api/cam", (answer, question) => {
      this.#render(answer);
      if (!answer.refused) this.#sizes.ask(question);
    }, failed);
    this.#sizes = new Latest("api/cam-sizes", ({ facts }, asked) => told(asked.study) === told(this.#study.state.cam) && this.#fact(facts), failed);
    this.#turning();
  }

  show(state) {
    const kind = state.cam.follower?.kind ?? "translating roller";
    if (kind !== this.#kind) this.#build(kind);
    for (const show of this.#shows) show(state.cam);
    this.#programme.show(state);
    this.#cams.ask({ study: state.cam });
  }

  #render(answer) {
    showTrust(element("cam-trust"), answer, [], () => {});
    if (!answer.refused) this.#fact(null);
    this.#motion.show(answer);
    this.#mechanism.show(answer);
  }

  /** What is known of the sizes stands below the words of trust; until it is, the space is kept. */
  #fact(facts) {
    element("cam-trust").querySelector(".sizes")?.remove();
    element("cam-trust").append(html("p", { class: "facts sizes", text: facts?.join(" · ") ?? "…" }));
  }

  #build(kind) {
    this.#kind = kind;
    this.#shows = [];
    const choose = html("select", { "aria-label": "kind of follower" }, ...Object.keys(FIELDS).map((value) => html("option", { value, text: value })));
    choose.value = kind;
    choose.addEventListener("change", () => this.#study.change("follower", (state) => {
      const swings = (name) => name.startsWith("oscillating");
      const unlike = swings(choose.value) !== swings(state.cam.follower.kind);
      state.cam.follower = { kind: choose.value, ...FIELDS[choose.value] };
      if (unlike) for (const segment of state.cam.motion.segment) if (segment.by) segment.by = swings(choose.value) ? "20 deg" : "35 mm";
      if (unlike) delete state.cam.motion.limits;
    }));
    const turning = html("select", { "aria-label": "turning" }, ...["counterclockwise", "clockwise"].map((value) => html("option", { value, text: value })));
    turning.addEventListener("change", () => this.#study.change("turning", (state) => (state.cam.turning = turning.value)));
    this.#shows.push((cam) => (turning.value = cam.turning ?? "counterclockwise"));
    const own = Object.keys(FIELDS[kind]).map((name) => this.#text(name, FIELDS[kind][name], (cam) => cam.follower));
    const sizes = Object.entries(SIZES).map(([name, usual]) => this.#text(name, usual, (cam) => cam));
    const entry = (name, field) => html("div", { class: "entry" }, html("span", { class: "field-name", text: name }), field);
    element("cam-size").replaceChildren(group("Follower", choose, ...own), group("Cam", ...sizes, entry("turning", turning)));
  }

  #text(name, placeholder, of) {
    const field = html("input", { type: "text", placeholder, spellcheck: "false", maxlength: 60, "aria-label": name.replaceAll("_", " ") });
    field.addEventListener("input", () => this.#study.change(name, (state) => {
      const value = field.value.trim();
      if (value) of(state.cam)[name] = value;
      else delete of(state.cam)[name];
    }));
    field.addEventListener("change", () => this.#study.rest());
    this.#shows.push((cam) => {
      const value = of(cam)?.[name] ?? "";
      if (document.activeElement !== field || field.value.trim() !== value) field.value = value;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: NAMES[name] ?? name, title: name.replaceAll("_", " ") }), field);
  }

  #turning() {
    this.#dial = html("input", { type: "range", min: 0, max: 360, step: 1, value: 0, "aria-label": "Angle of the cam, degrees" });
    this.#dial.addEventListener("input", () => this.#mechanism.turn(Number(this.#dial.value)));
    this.#play = html("button", { type: "button", text: "Play", onclick: () => (this.#playing === null ? this.#start() : this.#stop()) });
    element("cam-turning").replaceChildren(this.#play, this.#dial);
  }

  #start() {
    this.#play.textContent = "Pause";
    let last = performance.now();
    let angle = Number(this.#dial.value);
    const step = (now) => {
      angle = (angle + (SPEED * (now - last)) / 1000) % 360;
      last = now;
      this.#dial.value = Math.round(angle);
      this.#mechanism.turn(angle);
      this.#playing = document.getElementById("cam-view").hidden ? this.#stop() : requestAnimationFrame(step);
    };
    this.#playing = requestAnimationFrame(step);
  }

  #stop() {
    cancelAnimationFrame(this.#playing);
    this.#play.textContent = "Play";
    this.#playing = null;
    return null;
  }
}
