// When a robot has stopped, [data-replays], shows its last moments once, by the lab's own key; but not
// while a finger is on the page, nor to users who ask for less motion, who have a button for it.
(() => {
  "use strict";

  const less = matchMedia("(prefers-reduced-motion: reduce)");
  let known = undefined, touches = 0;

  function look() {
    const source = document.querySelector("[data-said]");
    if (source === null) return;
    const { said, replays } = source.dataset;
    if (known === undefined) known = replays === "yes" ? said : "";  // it had stopped before
    if (replays !== "yes" || said === known || touches > 0) return;
    known = said;
    if (!less.matches) boxesOverScene.press("p");
  }

  addEventListener("pointerdown", () => { touches += 1; }, { capture: true });
  for (const kind of ["pointerup", "pointercancel"]) {
    addEventListener(kind, () => {
      touches = Math.max(touches - 1, 0);
      setTimeout(look);
    }, { capture: true });
  }
  new MutationObserver(look).observe(document, { childList: true, subtree: true });
})();
