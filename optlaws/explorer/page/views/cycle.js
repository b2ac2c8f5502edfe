// The motion of an axis of the machine in machine units, its segments and its limits.

import { Latest } from "../latest.js";
import { column, explained, laidOut, panel, status } from "../layout.js";
import { join } from "../machine_forms.js";
import { Panels } from "../panels.js";
import { showTrust, table } from "../report.js";
import { Strip } from "../strip.js";
import { html } from "../svg.js";
import { listed } from "../units.js";

const FIRST = 5; // column of the table that is a peak

const WORDS = [
  ["position, velocity", "of the axis over a turn of the master, in the units of the machine; red is where a limit forbids to go"],
  ["segments", "the bars above the curves: drag the joints between them, or move them by arrow keys; a click on a bar shows it large"],
  ["least", "what is made as small as it can be over all segments without a law of their own"],
  ["free", "a segment whose positions and velocities at its ends are found with the law"],
];

export class View {
  files = ["python", "problem", "table"];
  moves = true;
  drawings = "#motion svg";
  #study;
  #at;
  #motion;
  #words = explained(WORDS);
  #answer = null;
  #ways = null;
  #cycles;
  #nearest;

  constructor(root, study) {
    this.#study = study;
    this.#at = laidOut(root, column("machine", "Motion in machine units", status("cycle-trust"), panel("motion"), panel("segments")));
    const strip = new Strip({ moved: (i, at) => this.#join(i, at), rested: () => study.rest(), chosen: (i) => this.#motion.look(this.#answer.segments[i].at) });
    this.#motion = new Panels(this.#at.motion, { strip });
    this.#motion.cursor.watch((at) => this.#mark(at));
    this.#cycles = new Latest("api/cycle", (...answer) => this.#answered(...answer));
    this.#nearest = new Latest("api/cycle-nearest", ({ ways }) => this.#render(this.#answer, ways), () => this.#render(this.#answer, []));
  }

  /** The request to the server, of which files are made too. */
  request({ machine, axis }) {
    return { study: machine, axis };
  }

  show(state) {
    this.#cycles.ask(this.request(state));
  }

  #answered(answer, question) {
    if (answer.refused?.word === "no such law") this.#nearest.ask(question);
    this.#render(answer, answer.refused?.word === "no such law" ? null : []);
  }

  #render(answer, ways) {
    this.#answer = answer;
    this.#ways = ways;
    showTrust(this.#at.trust, answer, this.#ways, (way) => this.#back(way));
    if (answer.facts) this.#at.trust.append(html("p", { class: "facts", text: listed(answer.facts) }));
    this.#motion.show(answer);
    this.#at.segments.replaceChildren(...(answer.refused ? [] : [segments(answer), ...beside(answer)]), this.#words);
  }

  /** Let a segment end at an angle, and the next one begin there. */
  #join(i, at) {
    const { segments, turn } = this.#answer;
    this.#study.change(`joint ${i}`, (state) => join((state.machine.axis[state.axis] ?? state.machine.axis[0]).segment, segments, { i, at, turn }));
  }

  /** The segment that the cursor is in stands out in the table. */
  #mark(at) {
    const within = at === null ? -1 : (this.#answer?.segments ?? []).findIndex(({ at: [from, to] }) => at >= from && at <= to);
    this.#at.segments.querySelectorAll("tbody tr").forEach((row, i) => (i === within ? row.setAttribute("aria-current", "true") : row.removeAttribute("aria-current")));
  }

  #back({ entry, value }) {
    this.#study.change(`back ${entry}`, (state) => {
      const axis = state.machine.axis[state.axis] ?? state.machine.axis[0];
      axis.limits = { ...axis.limits, [entry]: value };
    });
  }
}

/** What the laws take beside modified sine in the same moves, where they are optimised. */
function beside({ beside: known }) {
  return known ? [table("Beside modified sine", known.headings, known.rows)] : [];
}

function segments({ segments: known, table: { headings, rows } }) {
  const beyond = (i, j) => known[i]?.peaks[j - FIRST]?.beyond;
  return table("Segments with their peaks", headings, rows, { look: (i, j) => (beyond(i, j) ? { class: "over", title: "beyond its limit" } : {}) });
}
