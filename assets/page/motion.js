// Whoever asks for less motion finds the robots at rest: the lab is paused once when its page opens.
(() => {
  "use strict";

  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  const watch = new MutationObserver(() => {
    const source = document.querySelector("[data-said]");
    if (source === null) return;
    watch.disconnect();
    if (source.dataset.running !== "yes") return;
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key: " ", code: "Space", bubbles: true }));
  });
  watch.observe(document, { childList: true, subtree: true });
})();
