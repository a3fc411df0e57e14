// A dark page for users who prefer one: viser's dark mode, through its interface for pages that embed
// it. The lab, which draws the scene, reads the same entry; see DARK_KEY in app/server/lab_server.py. If
// the preference changes, the page is reloaded and comes back to the same lab, as soon as nothing is
// being typed or dragged. Printing does not count as a change.
(() => {
  "use strict";

  const KEPT_AS = "viser-user:dark";
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
})();
