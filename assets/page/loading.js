// Until the lab's page arrives, a cover (see style.css) hides viser's own panel.
(() => {
  "use strict";

  const root = document.documentElement;
  root.classList.add("op-loading");
  const observer = new MutationObserver(() => {
    if (document.querySelector("[data-page]") === null) return;
    root.classList.remove("op-loading");
    observer.disconnect();
  });
  observer.observe(document, { childList: true, subtree: true });
})();
