// The report that is printed, or saved as PDF by the browser, on one page: what is asked, what is found, how far it is
// proven, and by which optlaws; pictures and tables are those of the view.

import { html } from "./svg.js";
import { titled } from "./document.js";

const FIELDS = ".field:not(.off), .entry, .switch";

/** Keep a report ready for printing; `version` is that of optlaws. */
export function reporting(study, version) {
  const root = html("section", { id: "report", "aria-label": "Report" });
  document.querySelector(".skip").after(root);
  const fill = () => {
    const view = document.querySelector(".view:not([hidden])");
    const { state } = study;
    const date = new Date().toLocaleDateString(document.documentElement.lang, { dateStyle: "long" });
    root.replaceChildren(
      html("h1", { translate: "no", text: titled(state) }),
      html("p", { class: "quiet", text: `optlaws ${version} · ${date}`, translate: "no" }),
      ...(state.notes ? [html("p", { class: "notes", translate: "no", text: state.notes })] : []),
      ...groups(view),
    );
  };
  addEventListener("beforeprint", fill);
}

/** What the forms of a view ask, a paragraph for each of their groups. */
function groups(view) {
  return [...view.querySelectorAll("aside fieldset")].filter((one) => one.checkVisibility()).flatMap((group) => {
    const cards = [...group.querySelectorAll(".segment-card")];
    const of = (root) => [...root.querySelectorAll(FIELDS)].filter((one) => cards.includes(root) || !one.closest(".segment-card")).map(written).filter(Boolean);
    const parts = [...of(group), ...cards.map((card) => of(card).join(" "))];
    return parts.length ? [html("p", {}, html("strong", { text: group.querySelector("legend").textContent }), " ", parts.join(" · "))] : [];
  });
}

/** A field as its name and its value; nothing where it asks nothing. */
function written(field) {
  const name = field.querySelector(".field-name")?.textContent.trim() ?? field.textContent.trim();
  const input = [...field.querySelectorAll("input:not([type=range]), select, textarea")].find((one) => one.type !== "checkbox" || field.matches(".switch"));
  if (!input) return "";
  if (input.type === "checkbox") return input.checked ? name : "";
  const value = input.tagName === "SELECT" ? input.selectedOptions[0]?.textContent : input.value.trim();
  return value && value !== "0" ? `${name} ${value}` : "";
}
