// The document of this tab of the browser: a study with its name and notes. The address holds it, and the browser the last.

import { FIRST, read, written } from "./state.js";
import { keys, remove, store, stored } from "./store.js";
import { button, html } from "./svg.js";
import { VIEWS } from "./views.js";

const LAST = "optlaws-study";
const EARLIER = "optlaws-document-"; // documents that version 1.0 kept in tabs of the page

/** The state that the page begins with: of its address, of what the server was started with, or the last one. */
export function begun(hash, given) {
  if (hash.length > 1) return read(hash);
  const state = { ...structuredClone(FIRST), ...given };
  const last = written(state) === written(FIRST) ? stored(LAST) : null;
  return last === null ? state : read(last);
}

/** Store an address for the next time that the page is opened; whether the browser took it. */
export const keep = (address) => store(LAST, address);

/** Keys, titles and addresses of the documents of version 1.0; one that cannot be read stands under its key. */
function earlier() {
  return keys().filter((key) => key.startsWith(EARLIER)).map((key) => {
    try {
      const { title, address } = JSON.parse(stored(key));
      return { key, title: title || key, address };
    } catch {
      return { key, title: key };
    }
  });
}

/** What a document is called: its name, or what it shows. */
export function titled(state) {
  const file = state[VIEWS[state.view]?.part]?.title ?? state.laws[state.active]?.title ?? state.laws[state.active]?.name;
  return state.name || file || VIEWS[state.view]?.title || "Study";
}

/** The name and the notes, in a dialog; the title of the browser's tab. */
export function createDetails(study) {
  const name = html("input", { type: "text", maxlength: 80, "aria-label": "Name of the document" });
  const notes = html("textarea", { maxlength: 20_000, "aria-label": "Notes" });
  name.addEventListener("input", () => study.change("name", (state) => (state.name = name.value)));
  notes.addEventListener("input", () => study.change("notes", (state) => (state.notes = notes.value)));
  const done = button("Done", () => dialog.close());
  const links = earlier().map(({ key, title, address }) => {
    const item = html("li", {}, html("a", { href: address, target: "_blank", text: title }), " ", button("delete", () => {
      remove(key);
      item.remove();
    }, { class: "link", "aria-label": `Delete ${title}` }));
    return item;
  });
  const kept = links.length ? [html("h3", { text: "Documents of an earlier version" }), html("ul", {}, ...links)] : [];
  const dialog = html("dialog", { id: "document-dialog", "aria-label": "Document" }, html("h2", { text: "Document" }), html("label", {}, "name", name), html("label", {}, "notes", notes), ...kept, html("div", { class: "buttons" }, done));
  document.body.append(dialog);

  function show(state) {
    for (const [field, value] of [[name, state.name], [notes, state.notes]]) if (field.value !== value) field.value = value;
    document.title = `${titled(state)} - optlaws`;
  }

  return { show, open: () => dialog.showModal() };
}
