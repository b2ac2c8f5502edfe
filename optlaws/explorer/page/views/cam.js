// The view of a cam: mechanism and motion on the left, the cam that turns, pressure angle and curvature on the right.

import { explained, group } from "../fields.js";
import { listed, plain, written } from "../units.js";
import { Latest } from "../latest.js";
import { Mechanism } from "../mechanism.js";
import { Panels } from "../panels.js";
import { Programme } from "../programme.js";
import { Run } from "../run.js";
import { html } from "../svg.js";
import { showTrust, unanswered } from "../trust.js";

const told = (value) => JSON.stringify(value);
const element = (id) => document.getElementById(id);
const SIZES = { prime_radius: "60 mm", cutter_radius: "none", pressure_angle: "none, or 30 deg", radius_of_curvature: "none, or 15 mm" };
const NAMES = { prime_radius: "prime circle", cutter_radius: "cutter", pressure_angle: "pressure ≤", radius_of_curvature: "radius ≥", pivot_distance: "pivot", face_offset: "offset" };
const WORDS = {
  "prime circle": "about the shaft, through the centre of the roller, or through the flat face, where the follower is lowest; the field asks its radius",
  "base circle": "the smallest circle that touches the profile: the prime circle less the radius of the roller",
  "pressure angle": "between the way of the follower and the normal at the contact: the greater, the more the cam pushes sideways",
  "radius of curvature": "of the profile: small and convex is worn fast; hollow needs a cutter that is smaller",
  "undercut": "the profile crosses itself or has a cusp: no such cam can be cut",
  "cutter": "the radius of the tool; its path is the dashed line",
};
const LOADS = {
  slide: { mass: "none, or 2 kg", stiffness: "none, or 2 N/mm", preload: "none, or 60 N", gravity: "none, or 20 N" },
  arm: { inertia: "none, or 0.02 kg m^2", stiffness: "none, or 20 N m/rad", preload: "none, or 3 N m" },
};

const CUT = ["dxf spline", "dxf polyline", "dxf arcs", "svg", "csv", "csv polar", "g-code", "g-code arcs"];
const FILES = [
  { kind: "problem", text: "Problem file (TOML)", about: "For optlaws run" },
  ...CUT.map((format) => ({ kind: "cut", format, text: `Profile (${format})`, about: "The cam's edge, within 1 µm" })),
];

export class View {
  files = FILES;
  drawings = "#cam-curves svg";
  #study;
  #followers;
  #programme;
  #mechanism = new Mechanism(element("cam-drawing"));
  #motion = new Panels(element("cam-curves"));
  #cams;
  #sizes;
  #loads;
  #answer = null;
  #kind = "";
  #shows = [];
  #read = html("p", { class: "facts", id: "cam-reading", role: "status" });

  constructor(_root, study, { followers }) {
    this.#study = study;
    this.#followers = followers;
    this.#programme = new Programme(element("cam-programme"), study, (state) => state.cam);
    this.#cams = new Latest("api/cam", (answer, question) => {
      this.#render(answer);
      if (answer.refused) return;
      if (question.study.motion?.drive) this.#loads.ask(question);
      this.#sizes.ask(question);
    }, (error) => this.#render(unanswered(error)));
    this.#loads = new Latest("api/cam-loads", (loads, asked) => told(asked.study) === told(this.#study.state.cam) && this.#bear(loads), (error) => this.#bear({ panels: [], facts: [error.message] }));
    this.#sizes = new Latest("api/cam-sizes", ({ facts }, asked) => told(asked.study) === told(this.#study.state.cam) && this.#fact(facts), (error) => this.#fact([error.message]));
    this.#turning();
    this.#motion.cursor.watch((at) => this.#turn(at));
  }

  /** The part of a study that files are made of. */
  saved({ cam }) {
    return { cam: { study: cam } };
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
    this.#answer = answer;
    this.#motion.show(answer);
    this.#mechanism.show(answer);
  }

  /** What is known of the sizes stands below the words of trust; until it is, the space is kept. */
  #fact(facts) {
    element("cam-trust").querySelector(".sizes")?.remove();
    element("cam-trust").append(html("p", { class: "facts sizes", text: facts ? listed(facts) : "…" }));
  }

  /** What the cam bears stands below its geometry. */
  #bear({ panels, facts }) {
    element("cam-trust").querySelector(".loads")?.remove();
    if (facts.length) element("cam-trust").querySelector(".sizes")?.before(html("p", { class: "facts loads", text: listed(facts) }));
    this.#mechanism.bear(panels.find(({ name }) => name === "contact force") ?? null);
    if (this.#answer && !this.#answer.refused) this.#motion.show({ ...this.#answer, panels: [...this.#answer.panels, ...panels] });
  }

  #build(kind) {
    this.#kind = kind;
    this.#shows = [];
    const choose = html("select", { "aria-label": "kind of follower" }, ...Object.keys(this.#followers).map((value) => html("option", { value, text: value })));
    choose.value = kind;
    choose.addEventListener("change", () => this.#study.change("follower", (state) => {
      const swings = (name) => this.#followers[name].axis === "angle";
      const unlike = swings(choose.value) !== swings(state.cam.follower.kind);
      state.cam.follower = { kind: choose.value, ...this.#followers[choose.value].entries };
      if (unlike) for (const segment of state.cam.motion.segment) if (segment.by) segment.by = swings(choose.value) ? "20 deg" : "35 mm";
      if (unlike) for (const name of ["limits", "drive"]) delete state.cam.motion[name];
      if (unlike) for (const name of ["forces", "spring"]) delete state.cam[name];
    }));
    const turning = html("select", { "aria-label": "turning" }, ...["counterclockwise", "clockwise"].map((value) => html("option", { value, text: value })));
    turning.addEventListener("change", () => this.#study.change("turning", (state) => (state.cam.turning = turning.value)));
    this.#shows.push((cam) => (turning.value = cam.turning ?? "counterclockwise"));
    const own = Object.entries(this.#followers[kind].entries).map(([name, usual]) => this.#text(name, usual, (cam) => cam.follower));
    const sizes = Object.entries(SIZES).map(([name, usual]) => this.#text(name, usual, (cam) => cam));
    const entry = (name, field) => html("div", { class: "entry" }, html("span", { class: "field-name", text: name }), field);
    element("cam-size").replaceChildren(group("Follower", choose, ...own), group("Cam", ...sizes, entry("turning", turning)), group("Forces", ...this.#bearing(kind)));
  }

  /** What the follower moves, the width of the contact, friction, and up to which speed a spring is to hold. */
  #bearing(kind) {
    const drive = Object.entries(LOADS[this.#followers[kind].axis === "angle" ? "arm" : "slide"]);
    return [
      ...drive.map(([name, usual]) => this.#text(name, usual, (cam) => cam.motion.drive, (cam, value) => put(cam.motion, "drive", name, value))),
      this.#text("width", "none, or 20 mm", (cam) => cam.forces, (cam, value) => put(cam, "forces", "width", value)),
      this.#text("friction", "none, or 0.05", (cam) => ({ friction: cam.forces?.friction?.contact }), (cam, value) => {
        const friction = { ...cam.forces?.friction };
        put(cam, "forces", "friction", undefined);
        const held = { friction };
        put(held, "friction", "contact", Number.isFinite(Number(value)) && value ? Number(value) : value);
        if (held.friction) put(cam, "forces", "friction", held.friction);
      }),
      this.#text("spring", "none, or 300 rpm", (cam) => ({ spring: cam.spring?.speeds[1] }), (cam, value) => {
        if (value) cam.spring = { speeds: ["0 rpm", value] };
        else delete cam.spring;
      }),
    ];
  }

  /** A field of an entry of what `of` gives of the cam; `set` puts a value there, or takes it away where it is blank. */
  #text(name, placeholder, of, set = (cam, value) => (value ? (of(cam)[name] = value) : delete of(cam)[name])) {
    const field = html("input", { type: "text", placeholder, spellcheck: "false", maxlength: 60, "aria-label": name.replaceAll("_", " ") });
    field.addEventListener("input", () => this.#study.change(name, (state) => {
      set(state.cam, plain(field.value.trim()));
    }));
    field.addEventListener("change", () => this.#study.rest());
    this.#shows.push((cam) => {
      const value = String(of(cam)?.[name] ?? "");
      if (document.activeElement !== field || plain(field.value.trim()) !== value) field.value = value;
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: NAMES[name] ?? name, title: name.replaceAll("_", " ") }), field);
  }

  #turning() {
    const measure = html("input", { type: "checkbox", checked: true });
    measure.addEventListener("change", () => this.#mechanism.measure(measure.checked));
    new Run(element("cam-turning"), "the cam", this.#motion.cursor);
    element("cam-turning").append(html("label", { class: "switch" }, measure, "dimensions"));
    element("cam-turning").after(this.#read, explained(WORDS));
  }

  /** The cam, and what is read of it, are where the cursor of the curves is. */
  #turn(at) {
    if (at === null) return;
    this.#mechanism.turn(at);
    this.#read.textContent = [`at ${written({ value: Math.round(at), unit: "deg", digits: 6 })}`, ...this.#motion.readings].join(" · ");
  }
}

/** An entry of a part of what is held: blank ones go, and the part with its last one. */
function put(held, part, name, value) {
  const entries = { ...held[part], [name]: value };
  if (!value) delete entries[name];
  if (Object.keys(entries).length) held[part] = entries;
  else delete held[part];
}
