// Lays out a window that is taller than wide, such as an upright tablet's, as on a telephone: with the
// panel below the scene instead of beside it. viser asks for a telephone's width; PORTRAIT in
// app/scene/stage.py is the same on the server.
(() => {
  "use strict";

  const TELEPHONE = "(max-width: 36em)", PORTRAIT = "(max-aspect-ratio: 4/5)";
  const ask = window.matchMedia;
  window.matchMedia = (query) => ask.call(window, query === TELEPHONE ? `${query}, ${PORTRAIT}` : query);

  // In this layout, and on a page enlarged so much that little room is left beside the panel, the scene
  // has its own two buttons, since the panel shows a lesson's text or controls. See NARROW there.
  const NARROW = 0.8;
  const upright = ask.call(window, `${TELEPHONE}, ${PORTRAIT}`);

  // The lab asks for the entry whenever the scene's shape changes; see UPRIGHT_KEY in app/page/page.py.
  function keep() {
    try {
      localStorage.setItem("viser-user:upright", upright.matches ? "yes" : "no");
    } catch {}  // without storage, the lab goes by the shape of the scene
  }

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
  upright.addEventListener("change", () => {
    keep();
    look();
  });
  keep();
})();
