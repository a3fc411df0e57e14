// What the lab says, from [data-said]: messages over the scene, where the eye is, and for a screen
// reader what happens, in a live region that is not seen.
(() => {
  "use strict";

  const AGAIN = 8000;  // [ms], between announcements that differ in their numbers only
  const REST = 1500;  // [ms], between any two

  const box = document.createElement("div");
  const text = document.createElement("span");
  const cross = document.createElement("button");
  const region = document.createElement("div");
  box.id = "op-message";
  box.className = "op-over-scene";
  box.hidden = true;
  text.setAttribute("role", "status");
  cross.type = "button";
  cross.textContent = "\u00d7";
  cross.className = "op-cross";
  cross.addEventListener("click", () => { box.hidden = true; });
  const acts = ["slowly", "mend"].map((name) => {  // buttons that press a key of the lab
    const button = document.createElement("button"), key = { slowly: "p", mend: "e" }[name];
    button.type = "button";
    button.className = name === "mend" ? "op-act" : "op-quiet";
    button.hidden = true;
    button.addEventListener("click", () => {
      button.blur();
      const code = `Key${key.toUpperCase()}`;
      document.body.dispatchEvent(new KeyboardEvent("keydown", { key, code, bubbles: true }));
    });
    return { name, button };
  });
  box.append(text, ...acts.map(({ button }) => button), cross);
  region.id = "op-voice";
  region.setAttribute("aria-live", "polite");

  let spoken = "", wanted = "", spokenAt = -AGAIN, waiting = 0, said = "", told = "0";

  function sense(said) {
    return said.replace(/\d+/g, "");
  }

  function speak() {
    waiting = 0;
    if (wanted === spoken) return;
    const rest = sense(wanted) === sense(spoken) ? AGAIN : REST;
    const left = spokenAt + rest - performance.now();
    if (left > 0) {
      waiting = setTimeout(speak, left);
      return;
    }
    spoken = region.textContent = wanted;
    spokenAt = performance.now();
  }

  function show(said, level) {
    text.textContent = said;
    box.dataset.level = level;
    box.hidden = said === "";
    place();
  }

  // In the middle of what is seen of the scene, above what covers its lower part on a telephone,
  // and a message above an invitation.
  function place() {
    const scene = document.querySelector("canvas[data-engine]")?.getBoundingClientRect();
    if (!scene) return;
    const sheet = document.querySelector('.mantine-Paper-root[style*="bottom: 0"]');
    const bottom = Math.min(scene.bottom, sheet?.getBoundingClientRect().top ?? scene.bottom);
    let above = innerHeight - bottom + 12;
    for (const each of document.querySelectorAll(".op-over-scene")) {
      each.style.left = `${scene.left + scene.width / 2}px`;
      each.style.bottom = `${above}px`;
      each.style.maxWidth = `${Math.min(scene.width - 24, 560)}px`;
      above += each.offsetHeight && each.offsetHeight + 8;
    }
  }

  function look() {
    const source = document.querySelector("[data-said]");
    if (source === null) return;
    const { said: now, level, spoken: next, close, summary, summaries } = source.dataset;
    if (!document.body.contains(box)) document.body.append(box, region);
    cross.setAttribute("aria-label", close);
    if (now !== said) {  // what was closed, or has given way to a summary, does not come back
      said = now;
      show(said, level);
    }
    if (document.querySelector(".op-over-scene:not([hidden])")) place();
    for (const { name, button } of acts) {
      const label = source.dataset[name] ?? "";
      if (button.textContent === label) continue;
      button.textContent = label;
      button.hidden = label === "";
      place();
    }
    clearTimeout(waiting);
    if (summaries !== told) {  // asked for: now, and to be read, too
      told = summaries;
      spoken = region.textContent = summary;
      spokenAt = performance.now();
      if (level !== "stop") show(summary, "info");
    }
    wanted = next;
    if (wanted !== "") speak();
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
  addEventListener("resize", place);
  addEventListener("op-shown", place);
})();
