// Removes the arrow that viser draws from a dragged object to the mouse, because it covers the place
// that users look at. three.js announces its scenes to developer tools, and so to this script.
(() => {
  "use strict";

  const tools = window.__THREE_DEVTOOLS__ ??= new EventTarget();
  tools.addEventListener("observe", ({ detail: scene }) => {
    if (scene?.isScene !== true) return;
    const add = scene.add;
    scene.add = (...objects) => {
      for (const each of objects) {
        if (each?.type === "ArrowHelper") Object.defineProperty(each, "visible", { get: () => false, set() {} });
      }
      return add.apply(scene, objects);
    };
  });
})();
