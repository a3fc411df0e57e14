// Keys do not move the camera. viser listens to them at the document; this script runs before viser's, so there it
// gets a key first, after the page's own keys (assets/web/parts/keys.ts), and stops its propagation.
(() => {
  "use strict";

  const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];
  const CAMERA = ["KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE", ...ARROWS];  // by event.code

  document.addEventListener("keydown", (event) => {
    if (CAMERA.includes(event.code)) event.stopImmediatePropagation();
  });
})();
