// How far the active law can be trusted, in words; or why there is none, and how far one must go back. A click on "check this
// proof" is an event of its own, which the page answers.

import { html, renew } from "./svg.js";
import { listed, plain, written } from "./units.js";

export function showTrust(root, view, ways, go) {
  marked(root, view?.refused ? written(view.refused.reason) : "");
  root.classList.toggle("none", Boolean(view?.refused));
  if (!view) renew(root);
  else if (view.refused) renew(root, ...refusal(view.refused, ways, go));
  else if (view.trust) renew(root, ...trust(view.trust));
  else renew(root, html("p", {}, html("strong", { class: "word given", text: "given" }), " A law as it stands: nothing was optimised."));
}

/** Mark the fields of a view that a refusal names with the value that they have. */
export function marked(root, reason) {
  const quoted = [...reason.matchAll(/'([^']*)'/g)].map(([, value]) => value);
  for (const field of root.closest(".view").querySelectorAll("input[type=text]")) {
    const named = field.getAttribute("aria-label")?.match(/\w{3,}/g)?.some((word) => reason.includes(word));
    if (named && quoted.includes(plain(field.value.trim()))) field.setAttribute("aria-invalid", "true");
    else field.removeAttribute("aria-invalid");
  }
}

function trust({ status, word, advice, gap, facts, proof }) {
  return [
    html("p", {}, html("strong", { class: `word ${status}`, text: word }), ` ${written(advice)} `, html("span", { class: "quiet", text: gap })),
    html("p", { class: "facts", text: listed(facts) }),
    proof ? checking() : null,
  ].filter(Boolean);
}

/** The button by which the second checker is given what is shown. */
export function checking() {
  return html("p", {}, html("button", { type: "button", class: "link", "data-key": "prove", text: "check this proof", onclick: ({ target }) => target.dispatchEvent(new Event("prove", { bubbles: true })) }));
}

function refusal({ word, reason, tried }, ways, go) {
  const found = [html("p", { class: "reason", title: tried }, html("strong", { class: "word refused", text: word }), ` ${written(reason)}`)];
  if (ways === null) found.push(html("p", { class: "quiet", text: "looking for the nearest problem that has a law …" }));
  else if (ways.length) {
    const buttons = ways.map((way) => html("button", { type: "button", "data-entry": way.entry, "data-value": way.value, text: way.text, onclick: () => go(way) }));
    found.push(html("p", { class: "ways" }, "Go back: ", ...buttons));
  }
  return found;
}

/** The view of what has no answer: what was shown before is of another question. */
export function unanswered(error, title = "") {
  return { title, refused: { word: "no answer", reason: error.message, tried: "" } };
}
