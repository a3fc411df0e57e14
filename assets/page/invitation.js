// Invitations to a newcomer, from [data-invitation], over the scene. Their button presses a key of
// the lab; whoever skips them is not asked again: the lab reads the same place, see first_minute.py.
(() => {
  "use strict";

  const KEPT_AS = "viser-user:first_minute";

  const box = document.createElement("aside");
  const text = document.createElement("div");
  const act = document.createElement("button");
  const skip = document.createElement("button");
  box.id = "op-invitation";
  box.className = "op-over-scene";
  box.hidden = true;
  act.className = "op-act";
  act.type = skip.type = "button";
  skip.className = "op-quiet";
  box.append(text, act, skip);

  let shown = "", end = "", skipped = false;

  act.addEventListener("click", () => {
    const key = act.dataset.key, code = `Key${key.toUpperCase()}`;
    act.blur();  // it is about to go, and the focus with it
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key, code, bubbles: true }));
  });

  skip.addEventListener("click", () => {
    skipped = true;
    try {
      localStorage.setItem(KEPT_AS, end);
    } catch {}  // a browser that keeps nothing asks again next time
    look();
  });

  function look() {
    const words = document.querySelector("[data-invitation]")?.dataset;
    const next = skipped || words === undefined ? "" : words.invitation;
    if (next === shown) return;
    shown = next;
    box.hidden = next === "";
    if (box.hidden) return;
    if (!document.body.contains(box)) document.body.append(box);
    text.textContent = next;
    end = words.end;
    act.textContent = words.button;
    act.dataset.key = words.key;
    act.hidden = words.key === "";
    skip.textContent = words.skip;
    dispatchEvent(new Event("op-shown"));  // saying.js places it
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
})();
