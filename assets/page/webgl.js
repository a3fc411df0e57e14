// Tells the user when the scene's picture is lost, for instance because the graphics driver was restarted,
// and reloads the page when it can be drawn again; the lab goes on meanwhile.
(() => {
  "use strict";

  const lost = document.createElement("p");
  lost.className = "op-notice";
  lost.setAttribute("role", "alert");

  function ofScene(act) {
    return ({ target }) => {
      if (target instanceof Element && target.matches("canvas[data-engine]")) act();
    };
  }

  addEventListener("webglcontextlost", ofScene(() => {
    lost.textContent = ownWords.text().picture_lost;
    lost.lang = ownWords.language();
    document.body.append(lost);
  }), { capture: true });
  addEventListener("webglcontextrestored", ofScene(() => location.reload()), { capture: true });
})();
