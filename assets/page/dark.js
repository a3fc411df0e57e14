// A dark page for users who prefer one: viser's dark mode, through its interface for pages that embed
// it, and dark labels in the scene, whose colours are in viser's shaders. The lab, which draws the rest
// of the scene, reads the same entry; see DARK_KEY in app/server/lab_server.py. If the preference
// changes, the page is reloaded and comes back to the same lab, as soon as nothing is being typed or
// dragged. Printing does not count as a change.
(() => {
  "use strict";

  const KEPT_AS = "viser-user:dark";
  const SHADES = [
    ["gl_FragColor = vec4(0.0, 0.0, 0.0, a);", "gl_FragColor = vec4(0.93, 0.94, 0.96, a);"],
    ["gl_FragColor = vec4(1.0, 1.0, 1.0, 0.85 * vAlpha);",
      "gl_FragColor = vec4(0.09, 0.11, 0.14, 0.8 * vAlpha);"],
  ];

  const BUSY = 500;  // [ms] until the next attempt
  const asked = matchMedia("(prefers-color-scheme: dark)"), dark = asked.matches;
  let pressed = false;

  for (const [name, down] of [["pointerdown", true], ["pointerup", false], ["pointercancel", false]]) {
    addEventListener(name, () => { pressed = down; }, { capture: true });
  }

  function renew() {
    if (asked.matches === dark || matchMedia("print").matches) return;
    const typing = document.activeElement?.matches("input:not([type=checkbox]), textarea");
    if (pressed || typing) setTimeout(renew, BUSY);
    else location.reload();
  }

  asked.addEventListener("change", renew);
  try {
    localStorage.setItem(KEPT_AS, dark ? "yes" : "no");
  } catch {}  // a browser without storage has a light scene
  if (!dark) return;

  window.__VISER_EMBED_CONFIG__ = { darkMode: true };
  const context = WebGL2RenderingContext.prototype, shaderSource = context.shaderSource;
  context.shaderSource = function (shader, source) {
    for (const [light, shade] of SHADES) source = source.replace(light, shade);
    return shaderSource.call(this, shader, source);
  };
})();
