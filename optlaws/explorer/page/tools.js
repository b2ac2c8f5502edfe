// The tools of the head: undo, redo, the link, files to save, dark and light.

import { save, savings } from "./saving.js";
import { html } from "./svg.js";
import { toggle } from "./theme.js";

export class Tools {
  #undo;
  #redo;
  #export;

  /** `shown()` is the view that is shown. */
  constructor(root, study, notice, exporting, shown) {
    const button = (text, title, act) => html("button", { type: "button", title, text, onclick: act });
    this.#undo = button("Undo", "Undo (Ctrl Z)", () => study.undo());
    this.#redo = button("Redo", "Redo (Ctrl Shift Z)", () => study.redo());
    const link = button("Copy link", "Copy the address, which holds the whole study", async () => {
      try {
        await navigator.clipboard.writeText(location.href);
        link.textContent = "Copied";
      } catch {
        link.textContent = "It is in the address bar";
      }
      setTimeout(() => (link.textContent = "Copy link"), 1500);
    });
    this.#export = button("Export", "For a controller, with what it will run", () => exporting.open());
    root.replaceChildren(this.#undo, this.#redo, link, this.#export, menu(study, notice, shown), button("◐", "Dark or light", toggle));
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

function menu(study, notice, shown) {
  const list = html("div", { class: "list", role: "menu" });
  const details = html("details", { class: "menu" }, html("summary", { text: "Save" }), list);
  details.addEventListener("toggle", () => {
    if (!details.open) return;
    const items = (shown() ? savings(shown()) : []).map(({ kind, text, about, format }) => html("button", {
      type: "button", role: "menuitem", title: about, text, "data-kind": kind,
      onclick: () => {
        details.open = false;
        save(kind, shown(), study.state, format).catch((error) => notice(error.message));
      },
    }));
    list.replaceChildren(...items);
  });
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
