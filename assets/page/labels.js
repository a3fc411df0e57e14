// Texts in the scene. viser draws them black on a white box, which hides what is behind it and appears
// before its letters. Here they have a rim of the paper's colour instead, and are light on dark pages.
// The colours are in viser's shaders. The rim needs the pixels around a letter, which viser leaves out.
// Whether the page is dark, see assets/web/parts/look.ts, may change while the scene is shown.
(() => {
  "use strict";

  const DARK = "onpathDark";
  const ink = `mix(vec3(0.0), vec3(0.93, 0.94, 0.96), ${DARK})`, paper = `mix(vec3(1.0), vec3(0.09, 0.11, 0.14), ${DARK})`;
  const LETTERS = "gl_FragColor = vec4(0.0, 0.0, 0.0, a);";
  const CHANGES = [
    ["gl_FragColor = vec4(1.0, 1.0, 1.0, 0.85 * vAlpha);", "gl_FragColor = vec4(0.0); discard;"],
    ["if (a < 0.004) discard;", ""],
    [LETTERS, `
  float rim = 0.9 * smoothstep(-aa, aa, distPx + 0.35 * uSdfRadius) * vAlpha;
  if (rim < 0.004) discard;
  gl_FragColor = vec4(mix(${paper}, ${ink}, a), max(a, rim));`],
  ];

  const context = globalThis.WebGL2RenderingContext?.prototype;
  if (context === undefined) return;
  const { shaderSource, attachShader, useProgram } = context;
  const shaders = new WeakSet(), told = new WeakMap();  // of letters; a program -> whether it draws them light

  context.shaderSource = function (shader, source) {
    if (source.includes(LETTERS)) {
      shaders.add(shader);
      source = source.replace("void main() {", `uniform float ${DARK};\nvoid main() {`);
    }
    for (const [old, changed] of CHANGES) source = source.replace(old, changed);
    return shaderSource.call(this, shader, source);
  };
  context.attachShader = function (program, shader) {
    if (shaders.has(shader)) told.set(program, false);
    return attachShader.call(this, program, shader);
  };
  context.useProgram = function (program) {
    useProgram.call(this, program);
    if (!told.has(program)) return;
    const dark = document.documentElement.classList.contains("op-dark");
    if (told.get(program) === dark) return;
    told.set(program, dark);
    this.uniform1f(this.getUniformLocation(program, DARK), Number(dark));
  };
})();
