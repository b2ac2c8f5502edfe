// Documents in tabs: each a study with its name and notes. The browser keeps them; a closed one is kept and opened again.

import { FIRST, read, written } from "./state.js";
import { html, renew } from "./svg.js";
import { VIEWS } from "./views.js";

const KEY = "optlaws-document-";
const OPEN = "optlaws-open-document";

/** The document of an address that the page begins with: {id, state}. `given` is what the server shows of its command. */
export function begun(hash, given) {
  const kept = all();
  const own = kept.find(({ id }) => id === session());
  if (hash.length > 1) {
    const state = read(hash);
    const same = [own, ...kept].find((one) => one && one.address === written(state));
    return { id: same?.id ?? made(), state };
  }
  const state = { ...structuredClone(FIRST), ...given };
  const usual = written(state) === written(FIRST);
  const found = usual ? own ?? kept.filter(({ closed }) => !closed).at(-1) : kept.find(({ address }) => address === written(state));
  return found ? { id: found.id, state: read(found.address) } : { id: made(), state };
}

const made = () => `${Date.now().toString(36)}${Math.random().toString(36).slice(2, 6)}`;

function session() {
  try {
    return sessionStorage.getItem(OPEN);
  } catch {
    return null;
  }
}

/** All that are kept, those first that were begun first. */
function all() {
  try {
    return Object.keys(localStorage)
      .filter((key) => key.startsWith(KEY))
      .map((key) => ({ ...JSON.parse(localStorage.getItem(key)), id: key.slice(KEY.length) }))
      .sort((one, other) => (one.id < other.id ? -1 : 1));
  } catch {
    return [];
  }
}

/** What a document is called: its name, or what it shows. */
export function titled(state) {
  const file = state[state.view]?.title ?? state.laws[state.active]?.title ?? state.laws[state.active]?.name;
  return state.name || file || VIEWS[state.view]?.title || "Study";
}

export class Documents {
  #root;
  #study;
  #notice;
  #id;
  #steps = new Map();
  #dialog;
  #tabs = [];
  #shown = "";
  #name = html("input", { type: "text", maxlength: 80, "aria-label": "Name of the document" });
  #notes = html("textarea", { maxlength: 20_000, "aria-label": "Notes" });
  #closed = html("div");

  constructor(root, study, { id, notice }) {
    this.#root = root;
    this.#study = study;
    this.#notice = notice;
    this.#id = id;
    this.#name.addEventListener("input", () => study.change("name", (state) => (state.name = this.#name.value)));
    this.#notes.addEventListener("input", () => study.change("notes", (state) => (state.notes = this.#notes.value)));
    const done = html("button", { type: "button", text: "Done", onclick: () => this.#dialog.close() });
    this.#dialog = html("dialog", { id: "document-dialog", "aria-label": "Document" }, html("h2", { text: "Document" }), html("label", {}, "name", this.#name), html("label", {}, "notes", this.#notes), this.#closed, html("div", { class: "buttons" }, done));
    document.body.append(this.#dialog);
    addEventListener("storage", ({ key, newValue }) => this.#elsewhere(key, newValue));
    addEventListener("pagehide", () => study.keep());
    this.keep(written(study.state));
  }

  /** Keep the study of now under the document that is open. */
  keep(address) {
    try {
      sessionStorage.setItem(OPEN, this.#id);
      localStorage.setItem(KEY + this.#id, JSON.stringify({ title: titled(this.#study.state), address }));
      if (!this.#tabs.some(({ id }) => id === this.#id)) this.#list();
    } catch {
      this.#notice("This browser keeps no documents: copy the link, or save a file.");
    }
  }

  #list() {
    this.#tabs = all().filter(({ id, closed }) => !closed || id === this.#id).map(({ id, title }) => ({ id, title }));
  }

  /** Draw the tabs where they are not those that stand there already; names of now are in the state. */
  show(state) {
    for (const [field, value] of [[this.#name, state.name], [this.#notes, state.notes]]) if (field.value !== value) field.value = value;
    const shown = JSON.stringify([this.#id, titled(state), this.#tabs]);
    if (shown === this.#shown) return;
    this.#shown = shown;
    const tabs = this.#tabs;
    const parts = tabs.map(({ id, title }) => this.#tab(id, id === this.#id ? titled(state) : title, tabs.length > 1));
    const button = (text, about, act) => html("button", { type: "button", text, title: about, "aria-label": about, onclick: act });
    renew(this.#root, ...parts, button("+", "New document", () => this.add(structuredClone(FIRST))));
  }

  /** A new document with a state. */
  add(state) {
    this.#turn(made(), state);
  }

  /** Where another window changes this document, that of this window becomes one of its own: neither is lost. */
  #elsewhere(key, value) {
    const address = written(this.#study.state);
    if (key === KEY + this.#id && value !== null && JSON.parse(value).address !== address) {
      this.#id = made();
      this.keep(address);
    }
    this.#list();
    this.show(this.#study.state);
  }

  #tab(id, title, several) {
    const own = id === this.#id;
    const open = html("button", { type: "button", class: "open", translate: "no", "data-key": `document ${id}`, title, text: title, onclick: () => (own ? this.details() : this.#choose(id)) });
    const close = several ? html("button", { type: "button", class: "close", "data-key": `close ${id}`, "aria-label": `Close ${title}`, text: "×", onclick: () => this.#close(id) }) : null;
    return html("div", { class: "document", "aria-current": own ? "page" : null }, open, close);
  }

  #choose(id) {
    const kept = all().find((one) => one.id === id);
    if (kept) this.#turn(id, read(kept.address));
  }

  #turn(id, state) {
    const known = this.#steps.get(id);
    const same = known && written(known.state) === written(state);
    this.#study.keep();
    const before = this.#id;
    this.#id = id;
    this.#steps.set(before, this.#study.exchange(same ? known : { state }));
    this.#study.keep();
    this.#list();
    this.show(this.#study.state);
  }

  #close(id) {
    const kept = all().find((one) => one.id === id);
    const others = all().filter((one) => !one.closed && one.id !== id);
    if (id === this.#id) this.#choose(others.at(-1).id);
    localStorage.setItem(KEY + id, JSON.stringify({ title: kept.title, address: kept.address, closed: Date.now() }));
    this.#list();
    this.show(this.#study.state);
  }

  /** The name, the notes, and closed documents. */
  details() {
    const closed = all().filter((one) => one.closed && one.id !== this.#id).sort((one, other) => other.closed - one.closed);
    const items = closed.map(({ id, title }) => html("li", {}, html("button", { type: "button", class: "link", text: title, "aria-label": `Open ${title} again`, onclick: () => {
      this.#dialog.close();
      this.#choose(id);
    } })));
    this.#closed.replaceChildren(...(items.length ? [html("h3", { text: "Closed, to open again" }), html("ul", {}, ...items)] : []));
    this.#dialog.showModal();
  }
}
