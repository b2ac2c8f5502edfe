// Files that the reader saves: the browser downloads them, the server writes none.

import { titled } from "./document.js";
import { DOCUMENT } from "./opening.js";

/** What can be saved, by its kind: a view says of which of these it has files, or gives a file of its own like these. */
const KINDS = {
  python: { text: "Python", about: "Lines that reproduce what is seen" },
  problem: { text: "Problem file (TOML)", about: "For optlaws run" },
  law: { text: "Law (JSON)", about: "For optlaws law, compare and cycle; a solution with its proof for optlaws verify" },
  cycle: { text: "Cycle with its laws (JSON)", about: "For Cycle.from_json" },
  proof: { text: "Least time with its proof (JSON)", about: "For optlaws verify" },
  table: { text: "Table of values (CSV)", about: "The curves, or the rows of the table, in columns with their units" },
  report: { text: "Report (HTML)", about: "Facts, tables and curves on a page to print" },
  picture: { text: "Picture (SVG)", about: "The curves as they are seen" },
  document: { text: "Document (JSON)", about: "The name, the notes and all that is set, to open again here" },
};
const DRAWN = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "font-family", "font-size", "font-weight"];

/** What can be saved of a view. */
export function savings(view) {
  const own = [...view.files, ...(view.request ? ["report"] : []), ...(view.drawings ? ["picture"] : []), "document"];
  return own.map((file) => (typeof file === "string" ? { kind: file, ...KINDS[file] } : file));
}

/** What a file of the document is called. */
const named = (state) => titled(state).replace(/[^\p{L}\p{N}.]+/gu, "_").replace(/^[_.]+|[_.]+$/g, "") || "optlaws";

/** Save a file of a view in a state. */
export async function save(kind, view, state) {
  if (kind === "picture") return download(`${named(state)}.svg`, "image/svg+xml", picture(view.drawings));
  if (kind === "document") return download(`${named(state)}.json`, "application/json", JSON.stringify({ about: DOCUMENT, state }, null, 1));
  const answer = await fileOf(kind, view, state);
  return download(answer.name, answer.type, answer.text);
}

/** A file of a view in a state: its name, its type, its text. */
export async function fileOf(kind, view, state) {
  const response = await fetch("api/save", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ kind, view: state.view, request: view.request(state), ...(kind === "report" && { name: state.name, notes: state.notes }) }),
  });
  const answer = await response.json();
  if (answer.error) throw new Error(answer.error);
  return answer;
}

export function download(name, type, text) {
  const address = URL.createObjectURL(new Blob([text], { type }));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** The drawings of a view, one below the other, with what the style sheet says of them written into them. */
function picture(selector) {
  const drawings = [...document.querySelectorAll(selector)];
  const whole = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  let height = 0;
  for (const drawing of drawings) {
    const copy = drawing.cloneNode(true);
    const [from, to] = [drawing.querySelectorAll("*"), copy.querySelectorAll("*")];
    from.forEach((one, i) => written(one, to[i]));
    copy.setAttribute("y", height);
    height += Number(drawing.getAttribute("height"));
    whole.append(copy);
  }
  const width = Math.max(0, ...drawings.map((drawing) => Number(drawing.getAttribute("width"))));
  whole.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  whole.setAttribute("viewBox", `0 0 ${width} ${height}`);
  whole.setAttribute("width", width);
  whole.setAttribute("height", height);
  const ground = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  ground.setAttribute("width", "100%");
  ground.setAttribute("height", "100%");
  ground.setAttribute("fill", getComputedStyle(document.querySelector(".panel")).backgroundColor);
  whole.prepend(ground);
  return new XMLSerializer().serializeToString(whole);
}

function written(drawn, copy) {
  const style = getComputedStyle(drawn);
  for (const name of DRAWN) copy.setAttribute(name, style.getPropertyValue(name));
  copy.removeAttribute("class");
}
