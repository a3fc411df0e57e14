// Texts in the scene. viser draws them black on a white box, which hides what is behind it and appears
// before its letters. Here they have a rim of the paper's colour instead, and are light on dark pages.
// The colours are in viser's shaders. The rim needs the pixels around a letter, which viser leaves out.
(() => {
  "use strict";

  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const ink = dark ? "vec3(0.93, 0.94, 0.96)" : "vec3(0.0)", paper = dark ? "vec3(0.09, 0.11, 0.14)" : "vec3(1.0)";
  const CHANGES = [
    ["gl_FragColor = vec4(1.0, 1.0, 1.0, 0.85 * vAlpha);", "gl_FragColor = vec4(0.0); discard;"],
    ["if (a < 0.004) discard;", ""],
    ["gl_FragColor = vec4(0.0, 0.0, 0.0, a);", `
  float rim = 0.9 * smoothstep(-aa, aa, distPx + 0.35 * uSdfRadius) * vAlpha;
  if (rim < 0.004) discard;
  gl_FragColor = vec4(mix(${paper}, ${ink}, a), max(a, rim));`],
  ];

  const context = globalThis.WebGL2RenderingContext?.prototype, shaderSource = context?.shaderSource;
  if (context === undefined) return;
  context.shaderSource = function (shader, source) {
    for (const [old, changed] of CHANGES) source = source.replace(old, changed);
    return shaderSource.call(this, shader, source);
  };
})();
