// viser draws an arrow of its own from what is dragged to the mouse, over the very place that is
// looked at. three.js shows its scenes to developers' tools; this takes the arrow out of them.
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
