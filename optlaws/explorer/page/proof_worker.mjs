/* A file checked beside the page, so that the page can be used meanwhile. */

import { fileChecked } from "./proof_check.mjs";

self.addEventListener("message", ({ data: text }) => {
  const begin = performance.now();
  try {
    const results = fileChecked(JSON.parse(text)).map(({ path, verdict, detail }) => ({ path, verdict, detail }));
    self.postMessage({ results, seconds: (performance.now() - begin) / 1000 });
  } catch (error) {
    self.postMessage({ error: error.message });
  }
});

self.postMessage({ ready: true });
