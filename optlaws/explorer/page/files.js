// Files: what the reader opens, from a dialog or dropped onto the page, and what the browser downloads; the server reads and
// writes none of this machine.

import { titled } from "./document.js";
import { post } from "./latest.js";
import { whole } from "./state.js";
import { button, html, svg } from "./svg.js";

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
const DOCUMENT = "optlaws document";
const TAKEN = ".toml,.json,.csv,.txt,.tsv,.tab,.dat";
const LARGEST = 380_000; // a question's
/** What a file of a solution, or of a certificate alone, holds. */
const PROOF = /"(?:certificate|contacts|steps)"\s*:/;

/** What can be saved of a view. */
export function savings(view) {
  const own = [...view.files, ...(view.request ? ["report"] : []), ...(view.drawings ? ["picture"] : []), "document"];
  return own.map((file) => (typeof file === "string" ? { kind: file, ...KINDS[file] } : file));
}

/** What a file of the document is called. */
const named = (state) => titled(state).replace(/[^\p{L}\p{N}.]+/gu, "_").replace(/^[_.]+|[_.]+$/g, "") || "optlaws";

/** Save a file of a view in a state, under the name of the document where it has one. */
export async function save(kind, view, state) {
  if (kind === "picture") return download({ name: `${named(state)}.svg`, type: "image/svg+xml", text: picture(view.drawings) });
  if (kind === "document") return download({ name: `${named(state)}.json`, type: "application/json", text: JSON.stringify({ about: DOCUMENT, state }, null, 1) });
  const file = await fileOf(kind, view, state);
  return download(state.name ? { ...file, name: `${named(state)}${/\.\w+$/.exec(file.name)[0]}` } : file);
}

/** A file of a view in a state: its name, its type, its text. */
export const fileOf = (kind, view, state) => post("api/save", { kind, view: state.view, request: view.request(state), ...(kind === "report" && { name: state.name, notes: state.notes }) });

export function download({ name, type, text }) {
  const address = URL.createObjectURL(new Blob([text], { type }));
  html("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** The drawings of a view, one below the other, with what the style sheet says of them written into them. */
function picture(selector) {
  const drawings = [...document.querySelectorAll(selector)];
  let height = 0;
  const copies = drawings.map((drawing) => {
    const copy = drawing.cloneNode(true);
    const [from, to] = [drawing.querySelectorAll("*"), copy.querySelectorAll("*")];
    from.forEach((one, i) => {
      const style = getComputedStyle(one);
      for (const name of DRAWN) to[i].setAttribute(name, style.getPropertyValue(name));
      to[i].removeAttribute("class");
    });
    copy.setAttribute("y", height);
    height += Number(drawing.getAttribute("height"));
    return copy;
  });
  const width = Math.max(0, ...drawings.map((drawing) => Number(drawing.getAttribute("width"))));
  const ground = svg("rect", { width: "100%", height: "100%", fill: getComputedStyle(document.querySelector(".panel")).backgroundColor });
  return new XMLSerializer().serializeToString(svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height }, ground, ...copies));
}

/** `opened(state)` shows what a file holds, `prove(name, text)` checks its proof; `view()` is the view that is shown, which may
 *  take files of its own. */
export function createOpening(opened, notice, view, prove) {
  const field = html("input", { type: "file", accept: TAKEN, multiple: true, hidden: true, "aria-label": "Files to open", onchange: () => all([...field.files]) });
  document.body.append(field);
  const files = (event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!files(event)) return;
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", (event) => event.relatedTarget === null && document.body.classList.remove("dropping"));
  addEventListener("drop", (event) => {
    document.body.classList.remove("dropping");
    if (!files(event) || event.defaultPrevented) return;
    event.preventDefault();
    all([...event.dataTransfer.files]);
  });

  /** Open a file; one with a proof can be checked as well, and where the page opens no such file that is all. */
  async function one(file) {
    const text = /\.json$/i.test(file.name) ? await file.text() : "";
    const proves = PROOF.test(text);
    const check = () => prove(file.name, text);
    try {
      opened(await stateOf(file));
    } catch (error) {
      if (!proves) throw error;
      return check();
    }
    return proves ? notice(`${file.name} has a proof.`, button("check this proof", check)) : notice("");
  }

  function choose() {
    field.value = "";
    field.click();
  }

  async function all(files) {
    for (const file of files) {
      try {
        if (await view()?.dropped?.(file)) notice("");
        else await one(file);
      } catch (error) {
        notice(error.message);
      }
    }
  }

  return { choose };
}

/** The text of a file in UTF-8, in UTF-16 with its mark, in Latin-1 or, where signs would stand within words, in Windows-1250. */
export async function textOf(file) {
  if (file.size > LARGEST) throw new Error(`${file.name} is larger than ${LARGEST / 1000} kB: start \`optlaws explore\` with it`);
  const bytes = new Uint8Array(await file.arrayBuffer());
  const mark = { "255,254": "utf-16le", "254,255": "utf-16be" }[bytes.slice(0, 2).join()];
  if (mark) return new TextDecoder(mark).decode(bytes);
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    if (bytes.includes(0)) throw new Error(`${file.name} is not a text file`);
    const western = new TextDecoder("latin1").decode(bytes);
    return /\p{L}[\u0080-\u00bf\u00d7\u00f7]\p{L}/u.test(western) ? new TextDecoder("windows-1250").decode(bytes) : western;
  }
}

/** The state that shows a file. */
export async function stateOf(file) {
  const text = await textOf(file);
  const kept = file.name.toLowerCase().endsWith(".json") ? savedIn(text) : null;
  const { state } = kept ?? await post("api/open", { name: file.name.slice(-200), text });
  return whole(state, file.name);
}

/** What a text holds if it is a document that the page saved, else null. */
function savedIn(text) {
  try {
    const found = JSON.parse(text);
    return found?.about === DOCUMENT ? found : null;
  } catch {
    return null; // the server says where it is no JSON
  }
}
