// Shows invitations to newcomers, from [data-invitation], over the scene. Their button presses a key of
// the lab. Users who skip them are not asked again: the lab reads the same entry, see first_minute.py.
(() => {
  "use strict";

  const KEPT_AS = "viser-user:first_minute";

  const text = document.createElement("div");
  const act = boxesOverScene.button("op-act");
  const skip = document.createElement("button");
  const box = boxesOverScene.make("aside", "op-invitation", text, act, skip);
  skip.type = "button";
  skip.className = "op-quiet";

  let shown = "", end = "", skipped = false;

  skip.addEventListener("click", () => {
    skipped = true;
    try {
      localStorage.setItem(KEPT_AS, end);
    } catch {}  // a browser without storage asks again next time
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
    boxesOverScene.place();
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
})();
