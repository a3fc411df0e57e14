// A window that is higher than wide, as of a tablet that is held upright, is laid out as on a
// telephone: the panel below the scene instead of beside it. viser asks for a telephone's width; see
// PORTRAIT in app/scene/stage.py for the server's side of it.
(() => {
  "use strict";

  const TELEPHONE = "(max-width: 36em)", PORTRAIT = "(max-aspect-ratio: 4/5)";
  const ask = window.matchMedia;
  window.matchMedia = (query) => ask.call(window, query === TELEPHONE ? `${query}, ${PORTRAIT}` : query);

  // There the scene has its two buttons with it, since the panel shows a lesson's text or controls;
  // also where a page is so much enlarged that little is left beside the panel. See NARROW there.
  const NARROW = 0.8;
  const upright = ask.call(window, `${TELEPHONE}, ${PORTRAIT}`);

  function isNarrow() {
    const scene = document.querySelector("canvas[data-engine]");
    return upright.matches || scene !== null && scene.clientWidth < NARROW * scene.clientHeight;
  }

  const hold = boxesOverScene.button("op-act", "h"), run = boxesOverScene.button("op-act", " ");
  const bar = boxesOverScene.make("div", "op-bar", hold, run);

  function look() {
    const words = document.querySelector("[data-said]")?.dataset;
    const invited = document.querySelector("#op-invitation:not([hidden])") !== null;
    const hidden = !isNarrow() || invited || !words?.hold;
    if (!hidden) {
      if (hold.textContent !== words.hold) hold.textContent = words.hold;
      if (run.textContent !== words.run) run.textContent = words.run;
      if (!document.body.contains(bar)) document.body.append(bar);
    }
    if (bar.hidden === hidden) return;
    bar.hidden = hidden;
    boxesOverScene.place();
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
  upright.addEventListener("change", look);
})();
