// The motion of an axis of the machine in machine units, its segments and its limits.

import { Latest } from "../latest.js";
import { column, explained, laidOut, panel, status } from "../layout.js";
import { join } from "../machine_forms.js";
import { createPanels, createStrip } from "../panels.js";
import { showTrust, table } from "../report.js";
import { html } from "../svg.js";
import { listed } from "../units.js";

const FIRST = 5; // column of the table that is a peak

const WORDS = [
  ["position, velocity", "of the axis over a turn of the master, in the units of the machine; red is where a limit forbids to go"],
  ["segments", "the bars above the curves: drag the joints between them, or move them by arrow keys; a click on a bar shows it large"],
  ["least", "what is made as small as it can be over all segments without a law of their own"],
  ["free", "a segment whose positions and velocities at its ends are found with the law"],
];

export function createView(root, study) {
  const files = ["python", "problem", "table"];
  const words = explained(WORDS);
  let current = null;
  let waysBack = null;
  const elements = laidOut(root, column("machine", "Motion in machine units", status("cycle-trust"), panel("motion"), panel("segments")));
  const strip = createStrip({ moved: moveJoint, rested: () => study.rest(), chosen: (i) => motion.look(current.segments[i].at) });
  const motion = createPanels(elements.motion, { strip });
  motion.cursor.watch(mark);
  const cycles = new Latest("api/cycle", answered);
  const nearest = new Latest("api/cycle-nearest", ({ ways }) => render(current, ways), () => render(current, []));

  /** The request to the server, of which files are made too. */
  function request({ machine, axis }) {
    return { study: machine, axis };
  }

  function show(state) {
    cycles.ask(request(state));
  }

  function answered(answer, question) {
    if (answer.refused?.word === "no such law") nearest.ask(question);
    render(answer, answer.refused?.word === "no such law" ? null : []);
  }

  function render(answer, ways) {
    current = answer;
    waysBack = ways;
    showTrust(elements.trust, answer, waysBack, back);
    if (answer.facts) elements.trust.append(html("p", { class: "facts", text: listed(answer.facts) }));
    motion.show(answer);
    elements.segments.replaceChildren(...(answer.refused ? [] : [segments(answer), ...beside(answer)]), words);
  }

  /** Let a segment end at an angle, and the next one begin there. */
  function moveJoint(i, at) {
    const { segments, turn } = current;
    study.change(`joint ${i}`, (state) => join(state.machine.axis[state.axis].segment, segments, { i, at, turn }));
  }

  /** The segment that the cursor is in stands out in the table. */
  function mark(at) {
    const within = at === null ? -1 : (current?.segments ?? []).findIndex(({ at: [from, to] }) => at >= from && at <= to);
    elements.segments.querySelectorAll("tbody tr").forEach((row, i) => (i === within ? row.setAttribute("aria-current", "true") : row.removeAttribute("aria-current")));
  }

  function back({ entry, value }) {
    study.change(`back ${entry}`, (state) => {
      const axis = state.machine.axis[state.axis];
      axis.limits = { ...axis.limits, [entry]: value };
    });
  }

  return { files, moves: true, drawings: "#motion svg", request, show };
}

/** What the laws take beside modified sine in the same moves, where they are optimised. */
function beside({ beside: known }) {
  return known ? [table("Beside modified sine", known.headings, known.rows)] : [];
}

function segments({ segments: known, table: { headings, rows } }) {
  const beyond = (i, j) => known[i]?.peaks[j - FIRST]?.beyond;
  return table("Segments with their peaks", headings, rows, { look: (i, j) => (beyond(i, j) ? { class: "over", title: "beyond its limit" } : {}) });
}
