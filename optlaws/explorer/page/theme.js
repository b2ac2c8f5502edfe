// Dark and light: as the system says, unless the reader chose.

import { store, stored } from "./store.js";

const KEY = "optlaws-theme";
const dark = matchMedia("(prefers-color-scheme: dark)");

function current() {
  return document.documentElement.dataset.theme ?? (dark.matches ? "dark" : "light");
}

export function toggle() {
  const chosen = current() === "dark" ? "light" : "dark";
  document.documentElement.dataset.theme = chosen;
  store(KEY, chosen);
}

export function restore() {
  const chosen = stored(KEY);
  if (chosen === "dark" || chosen === "light") document.documentElement.dataset.theme = chosen;
}
