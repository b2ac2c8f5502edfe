// The tools of the head: undo, redo, the link, files to save, dark and light.

import { save, savings } from "./files.js";
import { choice, entry } from "./form.js";
import { present, reached } from "./latest.js";
import { toggle } from "./store.js";
import { button, html } from "./svg.js";
import { CHOICES, choose, chosen } from "./units.js";

/** `shown()` is the view that is shown. */
export function createTools(root, study, notice, { exporting, opening, details, shown }) {
  const tool = (text, title, act) => button(text, act, { title });
  const undo = tool("Undo", "Undo (Ctrl Z)", () => study.undo());
  const redo = tool("Redo", "Redo (Ctrl Shift Z)", () => study.redo());
  const link = tool("Link", "Copy the address, which holds the whole study", async () => {
    try {
      await navigator.clipboard.writeText(location.href);
      link.textContent = "Copied";
    } catch {
      link.textContent = "It is in the address bar";
    }
    setTimeout(() => (link.textContent = "Link"), 1500);
  });
  const exportButton = tool("Export", "For a controller, with what it will run", () => exporting.open());
  root.replaceChildren(
    tool("Open", "Open a problem file, a law, a table or a document", () => opening.choose()), tool("Notes", "Name and notes", () => details.open()),
    undo, redo, link, exportButton, saves(study, notice, shown), settings(study, notice), tool("◐", "Dark or light", toggle),
  );
  addEventListener("keydown", key);

  /** `exports` is whether the view has a motion for a controller. */
  function show(exports) {
    exportButton.disabled = !exports;
    undo.disabled = !study.canUndo;
    redo.disabled = !study.canRedo;
  }

  function key(event) {
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
    if (event.target.matches?.("input[type=text], input[type=number], input[list], textarea")) return;
    event.preventDefault();
    if (event.shiftKey) study.redo();
    else study.undo();
  }

  return { show };
}

function saves(study, notice, shown) {
  const list = html("div", { class: "list", role: "menu" });
  return menu("Save", list, (close) => {
    list.replaceChildren(...(shown() ? savings(shown()) : []).map(({ kind, text, about }) => button(text, () => {
      close();
      save(kind, shown(), study.state).catch((error) => notice(error.message));
    }, { role: "menuitem", title: about, "data-kind": kind })));
  });
}

/** Units: the page begins anew with them, the study stays. */
function settings(study, notice) {
  const fields = Object.entries(CHOICES).map(([name, units]) => entry(name, choice(name, units, chosen()[name], (unit) => {
    if (!choose(name, unit)) return void notice("The store of this browser is full, so that it keeps no units: delete what is not needed, under Notes.");
    study.keep();
    reached(present).then(() => location.reload());
  })));
  return menu("Settings", html("div", { class: "list settings" }, ...fields));
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
