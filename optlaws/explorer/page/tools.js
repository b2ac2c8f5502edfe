// The tools of the head: undo, redo, the link, files to save, dark and light.

import { save, savings } from "./files.js";
import { present, reached } from "./latest.js";
import { html } from "./svg.js";
import { toggle } from "./theme.js";
import { CHOICES, choose, chosen } from "./units.js";

export class Tools {
  #undo;
  #redo;
  #export;

  /** `shown()` is the view that is shown. */
  constructor(root, study, notice, { exporting, opening, details, shown }) {
    const button = (text, title, act) => html("button", { type: "button", title, text, onclick: act });
    this.#undo = button("Undo", "Undo (Ctrl Z)", () => study.undo());
    this.#redo = button("Redo", "Redo (Ctrl Shift Z)", () => study.redo());
    const link = button("Link", "Copy the address, which holds the whole study", async () => {
      try {
        await navigator.clipboard.writeText(location.href);
        link.textContent = "Copied";
      } catch {
        link.textContent = "It is in the address bar";
      }
      setTimeout(() => (link.textContent = "Link"), 1500);
    });
    this.#export = button("Export", "For a controller, with what it will run", () => exporting.open());
    root.replaceChildren(
      button("Open", "Open a problem file, a law, a table or a document", () => opening.choose()), button("Notes", "Name and notes", () => details.open()),
      this.#undo, this.#redo, link, this.#export, saves(study, notice, shown), settings(study, notice), button("◐", "Dark or light", toggle),
    );
    addEventListener("keydown", (event) => this.#key(event, study));
  }

  /** `exports` is whether the view has a motion for a controller. */
  show(study, exports) {
    this.#export.disabled = !exports;
    this.#undo.disabled = !study.canUndo;
    this.#redo.disabled = !study.canRedo;
  }

  #key(event, study) {
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
    if (event.target.matches?.("input[type=text], input[type=number], input[list], textarea")) return;
    event.preventDefault();
    if (event.shiftKey) study.redo();
    else study.undo();
  }
}

function saves(study, notice, shown) {
  const list = html("div", { class: "list", role: "menu" });
  return menu("Save", list, (close) => {
    const items = (shown() ? savings(shown()) : []).map(({ kind, text, about }) => html("button", {
      type: "button", role: "menuitem", title: about, text, "data-kind": kind,
      onclick: () => {
        close();
        save(kind, shown(), study.state).catch((error) => notice(error.message));
      },
    }));
    list.replaceChildren(...items);
  });
}

/** Units: the page begins anew with them, the study stays. */
function settings(study, notice) {
  const field = (name, options, value, act) => {
    const select = html("select", { "aria-label": name }, ...Object.entries(options).map(([key, text]) => html("option", { value: key, text, translate: "no" })));
    select.value = value;
    select.addEventListener("change", () => {
      if (!act(select.value)) return void notice("The store of this browser is full, so that it keeps no units: delete what is not needed, under Notes.");
      study.keep();
      reached(present).then(() => location.reload());
    });
    return html("label", { class: "entry" }, html("span", { class: "field-name", text: name }), select);
  };
  const units = Object.entries(CHOICES).map(([name, all]) => field(name, Object.fromEntries(all.map((unit) => [unit, unit])), chosen()[name], (unit) => choose(name, unit)));
  return menu("Settings", html("div", { class: "list settings" }, ...units));
}

/** A button with a list below it, which Escape and a click elsewhere close; `opened(close)` fills it. */
function menu(title, list, opened = () => {}) {
  const details = html("details", { class: "menu" }, html("summary", { text: title }), list);
  details.addEventListener("toggle", () => details.open && opened(() => (details.open = false)));
  addEventListener("click", (event) => {
    if (!details.contains(event.target)) details.open = false;
  });
  details.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    details.open = false;
    details.firstElementChild.focus();
  });
  return details;
}
