// A window that is higher than wide, as of a tablet that is held upright, is laid out as on a
// telephone: the panel below the scene instead of beside it. viser asks for a telephone's width; see
// PORTRAIT in app/scene/stage.py for the server's side of it.
(() => {
  "use strict";

  const TELEPHONE = "(max-width: 36em)", PORTRAIT = "(max-aspect-ratio: 4/5)";
  const ask = window.matchMedia;
  window.matchMedia = (query) => ask.call(window, query === TELEPHONE ? `${query}, ${PORTRAIT}` : query);

  // There the scene has its two buttons with it, since the panel shows a lesson's text or controls.
  const upright = ask.call(window, `${TELEPHONE}, ${PORTRAIT}`);
  const bar = document.createElement("div");
  const hold = document.createElement("button");
  const run = document.createElement("button");
  bar.id = "op-bar";
  bar.className = "op-over-scene";
  bar.hidden = true;
  hold.className = run.className = "op-act";
  hold.type = run.type = "button";
  bar.append(hold, run);

  function presses(button, key, code) {
    button.addEventListener("click", () => {
      button.blur();
      document.body.dispatchEvent(new KeyboardEvent("keydown", { key, code, bubbles: true }));
    });
  }

  presses(hold, "h", "KeyH");
  presses(run, " ", "Space");

  function look() {
    const words = document.querySelector("[data-said]")?.dataset;
    const invited = document.querySelector("#op-invitation:not([hidden])") !== null;
    const hidden = !upright.matches || invited || !words?.hold;
    if (!hidden) {
      if (hold.textContent !== words.hold) hold.textContent = words.hold;
      if (run.textContent !== words.run) run.textContent = words.run;
      if (!document.body.contains(bar)) document.body.append(bar);
    }
    if (bar.hidden === hidden) return;
    bar.hidden = hidden;
    dispatchEvent(new Event("op-shown"));
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
  upright.addEventListener("change", look);
})();
