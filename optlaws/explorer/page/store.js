// What the browser keeps for the page, as texts by their keys: all may be missing, or refused where it keeps nothing or is full.
// Dark and light too: as the system says, unless the reader chose.

export function stored(key) {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

/** Whether the browser took a text. */
export function store(key, text) {
  try {
    localStorage.setItem(key, text);
    return true;
  } catch {
    return false;
  }
}

/** The keys of all that is kept. */
export function keys() {
  try {
    return Object.keys(localStorage);
  } catch {
    return [];
  }
}

export const remove = (key) => localStorage.removeItem(key);

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
