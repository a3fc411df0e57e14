// A folder that its user has opened is open again when the page is drawn anew, as after a change of
// robot. It is known by its heading.
(() => {
  "use strict";

  const HEADING = ".mantine-Paper-root > .mantine-Paper-root:has(> svg)";
  const opened = new Set();  // headings
  const known = new WeakSet();  // headings on the page that have been seen to

  const isOpen = (heading) => heading.nextElementSibling?.getAttribute("aria-hidden") !== "true";

  document.addEventListener("click", (event) => {
    const heading = event.target instanceof Element ? event.target.closest(HEADING) : null;
    if (heading === null) return;
    known.add(heading);
    if (isOpen(heading)) opened.delete(heading.textContent);  // it is about to be closed
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
