// Curves in panels one below the other over one variable, read by one cursor, zoomed and moved together.
//
// An answer has {across, unit, note, range, ticks, panels, segments, active, symbol}: the name of the variable, its unit, what
// stands behind it, its range (a turn unless given), its ticks, its symbol, a panel for each quantity, the law whose curve is read first, and the segments of a motion,
// {name, at: [from, to]}. A panel is {name, unit, symbol, series, limits, peaks, ends, beyond, span, note}:
// `series` are its curves, each {at, values, name, law, dots}, `law` being the number of its colour, `dots` that points are drawn; `limits`
// are {from, to, value, least}, `peaks` {at, value, and text if it is no plain number}; `span` is what is in sight at least; `note` stands beside the name.
//
// Wheel, drag, + and - zoom and move; arrow keys move the cursor from place to place, Page keys from peak to peak.

import { Cursor } from "./cursor.js";
import { FOOT, Panel } from "./panel.js";
import { Span } from "./span.js";
import { html, sized } from "./svg.js";
import { number, panelsInUnits } from "./units.js";

const TURN = [0, 360];
const LEAST = 84;
const ZOOM = 1.5;
const CLICK = 4; // pixels within which a press is no drag

export class Panels {
  #root;
  #size;
  #drawings = html("div", { class: "drawings" });
  #dial = html("input", { type: "range", class: "dial", "aria-label": "Cursor along the curves" });
  #value = html("output", { class: "cursor-value" });
  #buttons = {};
  #shown = null;
  #panels = [];
  #span = new Span();
  #drag = null;
  #strip;

  /** `strip` draws the segments above the curves: {element, show(answer, span, edges)}. */
  constructor(root, { cursor = new Cursor(), strip = null } = {}) {
    this.#root = root;
    this.#strip = strip;
    this.cursor = cursor;
    root.classList.add("panels");
    root.tabIndex = -1;
    const button = (name, text, title, act) => (this.#buttons[name] = html("button", { type: "button", text, title, "aria-label": title, onclick: act }));
    const tools = html(
      "div", { class: "panel-tools" }, this.#dial, this.#value,
      button("out", "−", "Show more of the curves", () => this.#zoom(ZOOM)),
      button("in", "+", "Show less of the curves, larger", () => this.#zoom(1 / ZOOM)),
      button("whole", "whole", "Show the whole curves", () => this.#reset()),
    );
    root.replaceChildren(...(strip ? [strip.element] : []), this.#drawings, tools);
    cursor.watch((at) => this.#read(at));
    this.#dial.addEventListener("input", () => this.#place(Number(this.#dial.value)));
    root.addEventListener("keydown", (event) => this.#key(event));
    const listen = (kind, act) => this.#drawings.addEventListener(kind, (event) => act.call(this, event));
    listen("pointermove", this.#point);
    listen("pointerleave", () => this.cursor.point(null));
    listen("pointerdown", this.#grasp);
    listen("pointerup", this.#release);
    listen("pointercancel", () => (this.#drag = null));
    listen("dblclick", this.#reset);
    this.#drawings.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    this.#size = sized(this.#drawings, () => this.#draw());
  }

  show(answer) {
    this.#shown = panelsInUnits(answer);
    this.#draw();
  }

  /** What the cursor reads: the name, the unit and the value of each panel. */
  get readings() {
    const at = this.cursor.at;
    return at === null ? [] : this.#panels.map((panel) => panel.read(at)).filter(Boolean);
  }

  /** Show a part of the range. */
  look([from, to]) {
    this.#span.to(from, to);
    this.#draw();
  }

  #draw() {
    const [width, room] = this.#size();
    if (!this.#shown || width < 100) return;
    const nothing = this.#shown.refused;
    this.#root.classList.toggle("empty", Boolean(nothing));
    this.#panels = [];
    if (nothing) {
      this.#drawings.replaceChildren(html("div", { class: "nothing" }, html("strong", { text: nothing.word }), html("span", { text: "there is nothing to draw" })));
      return;
    }
    const answer = { range: TURN, ...this.#shown };
    const { panels, segments } = answer;
    this.#span.of(answer.range);
    const { shown: span, zoomed } = this.#span;
    const height = Math.max(LEAST, Math.floor((room - FOOT) / panels.length));
    this.#panels = panels.map((panel, i) => new Panel(
      panel,
      { answer, span, zoomed, segments, active: answer.active ?? 0, name: `${this.#root.id}-${i}`, beyond: beyond(panel, segments ?? [], i) },
      { width, height, last: i === panels.length - 1 },
    ));
    this.#drawings.replaceChildren(...this.#panels.map(({ element }) => element));
    // what is scrolled is reached by keys too
    if (height * panels.length + FOOT > room) this.#drawings.tabIndex = 0;
    else this.#drawings.removeAttribute("tabindex");
    this.#strip?.show(answer, span);
    this.#dial.min = span[0];
    this.#dial.max = span[1];
    this.#dial.step = "any";
    this.#root.classList.toggle("zoomed", zoomed);
    this.#buttons.whole.disabled = this.#buttons.out.disabled = !zoomed;
    this.#read(this.cursor.at);
  }

  #read(at) {
    if (!this.#panels.length) return;
    const texts = this.#panels.map((panel) => panel.read(at)).filter(Boolean);
    const here = at === null ? "" : `${this.#shown.symbol ? `${this.#shown.symbol} = ` : ""}${number(at, this.#shown.unit)}`;
    this.#value.textContent = here;
    this.#dial.value = at ?? this.#span.shown[0];
    this.#dial.setAttribute("aria-valuetext", at === null ? "not placed" : `${here}: ${texts.join(", ")}`);
  }

  /** Put the cursor at the place nearest to a value. */
  #place(value) {
    const panel = this.#panels[0];
    if (panel) this.cursor.place(panel.nearest(value));
  }

  #under(event) {
    return this.#panels.find(({ element }) => element.contains(event.target)) ?? (this.#drag && this.#panels[0]);
  }

  #within(value) {
    const [from, to] = this.#span.shown;
    return Math.min(to, Math.max(from, value));
  }

  #point(event) {
    const panel = this.#under(event);
    if (!panel) return;
    if (this.#drag && this.#span.zoomed && Math.abs(event.clientX - this.#drag.began) >= CLICK) {
      this.#drawings.setPointerCapture(event.pointerId);
      this.#span.move(panel.at(this.#drag.from) - panel.at(event.clientX));
      this.#drag.from = event.clientX;
      this.#drag.moved = true;
      this.#draw();
    } else this.cursor.point(panel.nearest(this.#within(panel.at(event.clientX))));
  }

  #grasp(event) {
    if (event.button === 0 && this.#panels.length) this.#drag = { began: event.clientX, from: event.clientX, moved: false };
  }

  #release(event) {
    const panel = this.#under(event);
    const click = this.#drag && !this.#drag.moved;
    this.#drag = null;
    if (click && panel) this.cursor.place(panel.nearest(this.#within(panel.at(event.clientX))));
  }

  #wheel(event) {
    const panel = this.#under(event);
    // at the whole range the wheel scrolls the page on
    if (!panel || (event.deltaY > 0 && !this.#span.zoomed)) return;
    event.preventDefault();
    if (event.shiftKey) this.#span.move((Math.sign(event.deltaY || event.deltaX) * (this.#span.shown[1] - this.#span.shown[0])) / 8);
    else this.#span.zoom(this.#within(panel.at(event.clientX)), ZOOM ** Math.sign(event.deltaY));
    this.#draw();
  }

  #zoom(times) {
    const [from, to] = this.#span.shown;
    const at = this.cursor.at;
    this.#span.zoom(at !== null && at >= from && at <= to ? at : (from + to) / 2, times);
    this.#draw();
  }

  #reset() {
    this.#span.reset();
    this.#draw();
  }

  #key(event) {
    const [from, to] = this.#span.shown;
    const acts = { "+": () => this.#zoom(1 / ZOOM), "-": () => this.#zoom(ZOOM), 0: () => this.#reset(), Escape: () => this.cursor.place(null) };
    const moves = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
    const onDial = event.target === this.#dial;
    if (event.ctrlKey || event.metaKey || event.altKey || (!onDial && !Object.hasOwn(acts, event.key))) return;
    const panel = this.#panels[0];
    const at = this.cursor.at ?? from;
    const go = (value) => {
      if (value === undefined) return;
      this.#span.reach(value);
      this.#draw();
      this.cursor.place(value);
    };
    const next = (places, by) => {
      const sorted = [...new Set(places)].sort((one, other) => one - other);
      return by > 0 ? sorted.filter((one) => one > at + 1e-9)[by - 1] ?? sorted.at(-1) : sorted.findLast((one) => one < at - 1e-9) === undefined ? sorted[0] : sorted.filter((one) => one < at - 1e-9).at(by);
    };
    if (Object.hasOwn(acts, event.key)) acts[event.key]();
    else if (!panel) return;
    else if (event.key in moves) go(next(panel.places, moves[event.key] * (event.shiftKey ? 10 : 1)));
    else if (event.key === "PageUp" || event.key === "PageDown") go(next(this.#panels.flatMap(({ peaks }) => peaks), event.key === "PageUp" ? 1 : -1));
    else if (event.key === "Home" || event.key === "End") go(event.key === "Home" ? from : to);
    else return;
    event.preventDefault();
  }
}

/** Where a panel is beyond its limits, as [from, to]: all of it, or the segments that break their own. */
function beyond(panel, segments, i) {
  if (panel.beyond !== undefined) return panel.beyond ? [[-Infinity, Infinity]] : [];
  return segments.filter(({ peaks }) => peaks?.[i - 1]?.beyond).map(({ at }) => at);
}
