// Whoever asks for less motion finds the robots at rest: the lab is paused when its page opens, by
// its own key. The key may come before viser listens to it, so it is pressed again until it helps.
(() => {
  "use strict";

  const REST = 2000;  // [ms], in which an answer has come
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
