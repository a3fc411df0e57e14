// Tells the user when the scene's picture is lost, for instance because the graphics driver was restarted,
// and reloads the page when it can be drawn again; the lab goes on meanwhile. Without WebGL there is no
// scene, and so no lab: the page says so, and links to the course, which does not need WebGL.
(() => {
  "use strict";

  function made(tag, text, ...parts) {
    const element = document.createElement(tag);
    element.textContent = text;
    element.append(...parts);
    return element;
  }

  function show(box) {
    box.lang = ownWords.language();
    document.body.append(box);
  }

  if (!webgl.works) {
    const said = ownWords.text();
    const box = made("main", "", made("h1", said.no_webgl), made("p", said.no_webgl_why), made("p", said.course));
    box.id = "op-no-webgl";
    if (said.course_url) {
      const link = made("a", said.course_link);
      link.href = said.course_url;
      box.append(made("p", "", link));
    }
    addEventListener("DOMContentLoaded", () => show(box));
    return;
  }

  const lost = made("p", "");
  lost.className = "op-notice";
  lost.setAttribute("role", "alert");

  function ofScene(act) {
    return ({ target }) => {
      if (target instanceof Element && target.matches("canvas[data-engine]")) act();
    };
  }

  addEventListener("webglcontextlost", ofScene(() => {
    lost.textContent = ownWords.text().picture_lost;
    show(lost);
  }), { capture: true });
  addEventListener("webglcontextrestored", ofScene(() => location.reload()), { capture: true });
})();
