// What the browser keeps for the page, as texts by their keys: all may be missing, or refused where it keeps nothing or is full.

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
