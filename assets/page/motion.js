// For users who ask for less motion, pauses the lab when its page opens, by the lab's own key. viser may
// not listen to keys yet, so the key is pressed again until it works.
(() => {
  "use strict";

  const REST = 2000;  // [ms], by which an answer has arrived
  const MOST = 5;

  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  let pressed = 0, pressedAt = -REST;
  const watch = new MutationObserver(() => {
    const source = document.querySelector("[data-said]");
    if (source === null || performance.now() < pressedAt + REST) return;
    if (source.dataset.running !== "yes" || pressed === MOST) {
      watch.disconnect();
      return;
    }
    pressed += 1;
    pressedAt = performance.now();
    const key = { key: " ", code: "Space", bubbles: true };
    document.body.dispatchEvent(new KeyboardEvent("keydown", key));
  });
  watch.observe(document, { childList: true, subtree: true });
})();
