// How finely the scene is drawn: plainly in a browser that draws in software, which spends most of its
// time on drawing, and finely elsewhere. The lab, which builds the scene, is told by the page's greeting; see
// assets/web/channel/channel.ts. In software, edges are not smoothed, the canvases of plots are
// kept in memory, and the background picture, which viser draws even when there is none, is left out.
const webgl = (() => {
  "use strict";

  const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

  const canvas = HTMLCanvasElement.prototype, getContext = canvas.getContext;
  const probe = document.createElement("canvas").getContext("webgl2");
  if (probe === null) return { works: false, plain: true };
  const unmasked = probe.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL;
  const plain = SOFTWARE.test(probe.getParameter(unmasked ?? probe.RENDERER));
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  if (!plain) return { works: true, plain };

  canvas.getContext = function (kind, options) {
    const cheap = kind === "2d" ? { willReadFrequently: true } : { antialias: false };
    return getContext.call(this, kind, { ...options, ...cheap });
  };
  const tools = window.__THREE_DEVTOOLS__ ??= new EventTarget();
  tools.addEventListener("observe", ({ detail: scene }) => {
    if (scene?.isScene !== true) return;
    const add = scene.add;
    scene.add = (...objects) => {
      for (const each of objects) {
        if (each?.material?.uniforms?.depthMap) Object.defineProperty(each, "visible", { value: false });
      }
      return add.apply(scene, objects);
    };
  });
  return { works: true, plain };
})();
