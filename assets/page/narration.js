// Shows the lab's messages, from [data-said], over the scene, where users look, and tells screen readers
// what happens, in an invisible live region.
(() => {
  "use strict";

  const AGAIN = 8000;  // [ms], between announcements that differ only in numbers
  const REST = 1500;  // [ms], between any two
  const STAYS = 8000, PER_LETTER = 60;  // [ms] that a notice stays, unless it is pointed at

  const upright = matchMedia("(max-width: 36em), (max-aspect-ratio: 4/5)");
  const text = document.createElement("span");
  const cross = document.createElement("button");
  const region = document.createElement("div");
  const keys = { slowly: "p", end: "Escape", reset: "r", earlier: "e" };
  const acts = Object.entries(keys).map(([name, key]) => {
    const button = boxesOverScene.button(name === "earlier" ? "op-act" : "op-quiet", key);
    button.dataset.name = name;
    button.hidden = true;
    return button;
  });
  const box = boxesOverScene.make("div", "op-message", text, ...acts, cross);
  text.setAttribute("role", "status");
  cross.type = "button";
  cross.textContent = "\u00d7";
  cross.className = "op-cross";
  cross.addEventListener("click", () => { box.hidden = true; });
  region.id = "op-voice";
  region.setAttribute("aria-live", "polite");

  let spoken = "", wanted = "", spokenAt = -AGAIN, waiting = 0, leaving = 0, said = "", told = "0";

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
    box.dataset.place = level === "replay" && upright.matches ? "top" : "bottom";
    box.hidden = said === "";
    clearTimeout(leaving);
    if (level === "info" || level === "warning") leave(STAYS + PER_LETTER * said.length);
    boxesOverScene.place();
  }

  // Errors stay until they are over; other notices leave by themselves.
  function leave(after) {
    leaving = setTimeout(() => {
      if (box.matches(":hover, :focus-within")) leave(STAYS);
      else box.hidden = true;
    }, after);
  }

  function look() {
    const source = document.querySelector("[data-said]");
    if (source === null) return;
    const { said: now, level, spoken: next, close, summary, summaries } = source.dataset;
    if (!document.body.contains(box)) document.body.append(box, region);
    cross.setAttribute("aria-label", close);
    if (now !== said) {  // a message that was closed or replaced by a summary does not come back
      said = now;
      show(said, level);
    }
    boxesOverScene.place();
    for (const button of acts) {
      const label = source.dataset[button.dataset.name] ?? "";
      if (button.textContent === label) continue;
      button.textContent = label;
      button.hidden = label === "";
      boxesOverScene.place();
    }
    clearTimeout(waiting);
    if (summaries !== told) {  // requested, so announced at once and also shown
      told = summaries;
      spoken = region.textContent = summary;
      spokenAt = performance.now();
      if (level !== "stop") show(summary, "info");
    }
    wanted = next;
    if (wanted !== "") speak();
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
})();
