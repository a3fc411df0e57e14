// Reopens the folders that the user had opened when the page is drawn anew, for instance after a change
// of robot. A folder is identified by its heading.
(() => {
  "use strict";

  const HEADING = ".mantine-Paper-root > .mantine-Paper-root:has(> svg)";
  const opened = new Set();  // headings
  const known = new WeakSet();  // headings on the page that have been handled

  const isOpen = (heading) => heading.nextElementSibling?.getAttribute("aria-hidden") !== "true";

  document.addEventListener("click", (event) => {
    const heading = event.target instanceof Element ? event.target.closest(HEADING) : null;
    if (heading === null) return;
    known.add(heading);
    if (isOpen(heading)) opened.delete(heading.textContent);  // it is about to close
    else opened.add(heading.textContent);
  }, { capture: true });

  new MutationObserver(() => {
    if (opened.size === 0) return;
    for (const heading of document.querySelectorAll(HEADING)) {
      if (known.has(heading)) continue;
      known.add(heading);
      if (opened.has(heading.textContent) && !isOpen(heading)) heading.click();
    }
  }).observe(document, { childList: true, subtree: true });
})();
