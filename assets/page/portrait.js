// Lays out a window that is taller than wide, such as an upright tablet's, as on a telephone: with the
// panel below the scene instead of beside it. viser asks for a telephone's width; NARROW in
// app/scene/stage.py is the same on the server. Also tells the lab of low windows.
(() => {
  "use strict";

  const TELEPHONE = "(max-width: 36em)", PORTRAIT = "(max-aspect-ratio: 4/5)";
  const ask = window.matchMedia;
  window.matchMedia = (query) => ask.call(window, query === TELEPHONE ? `${query}, ${PORTRAIT}` : query);

  const upright = ask.call(window, `${TELEPHONE}, ${PORTRAIT}`), low = ask.call(window, "(max-height: 34em)");

  // The lab asks for the entry whenever the scene's shape changes; see SHAPE_KEY in app/page/page.py.
  function keep() {
    try {
      localStorage.setItem("viser-user:shape", upright.matches ? "upright" : low.matches ? "low" : "wide");
    } catch {}  // without storage, the lab goes by the shape of the scene
  }

  for (const shape of [upright, low]) shape.addEventListener("change", keep);
  keep();
})();
