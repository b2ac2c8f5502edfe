// Files that the reader opens, from a dialog or dropped onto the page: the server reads problem files, laws and tables.

import { whole } from "./state.js";
import { html } from "./svg.js";

const TAKEN = ".toml,.json,.csv,.txt,.tsv,.tab,.dat";
const LARGEST = 380_000; // a question's
/** What a file of a solution, or of a certificate alone, holds. */
const PROOF = /"(?:certificate|contacts|steps)"\s*:/;
export const DOCUMENT = "optlaws document";

/** `opened(state)` shows what a file holds, `prove(name, text)` checks its proof; `view()` is the view that is shown, which may
 *  take files of its own. */
export class Opening {
  #opened;
  #notice;
  #view;
  #prove;
  #field = html("input", { type: "file", accept: TAKEN, multiple: true, hidden: true, "aria-label": "Files to open" });

  constructor(opened, notice, view, prove) {
    this.#opened = opened;
    this.#notice = notice;
    this.#view = view;
    this.#prove = prove;
    document.body.append(this.#field);
    this.#field.addEventListener("change", () => this.#all([...this.#field.files]));
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
      this.#all([...event.dataTransfer.files]);
    });
  }

  /** Open a file; one with a proof can be checked as well, and where the page opens no such file that is all. */
  async #one(file) {
    const text = /\.json$/i.test(file.name) ? await file.text() : "";
    const proves = PROOF.test(text);
    const check = () => this.#prove(file.name, text);
    try {
      this.#opened(await stateOf(file));
    } catch (error) {
      if (!proves) throw error;
      return check();
    }
    return proves ? this.#notice(`${file.name} has a proof.`, html("button", { type: "button", text: "check this proof", onclick: check })) : this.#notice("");
  }

  choose() {
    this.#field.value = "";
    this.#field.click();
  }

  async #all(files) {
    for (const file of files) {
      try {
        if (await this.#view()?.dropped?.(file)) this.#notice("");
        else await this.#one(file);
      } catch (error) {
        this.#notice(error.message);
      }
    }
  }
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
  if (kept) return whole(kept.state, file.name);
  const response = await fetch("api/open", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ name: file.name.slice(-200), text }) });
  const answer = await response.json();
  if (answer.error) throw new Error(answer.error);
  return whole(answer.state, file.name);
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
