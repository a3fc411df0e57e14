// Scrolls the panel of a lesson's new step to its top; otherwise it would stay where the step before was.
// After a prediction, brings what to do next, [data-act], into view with its button.
(() => {
  "use strict";

  let shown = "", acting = null;

  function look() {
    const act = document.querySelector("[data-act]");
    if (act !== acting) {
      acting = act;
      const place = act?.closest("[class*=mantine]") ?? act;
      if (act !== null) requestAnimationFrame(() => place.scrollIntoView({ block: "center" }));
    }
    const heading = document.querySelector("[data-step]");
    if (heading === null || heading.dataset.step === shown) return;
    shown = heading.dataset.step;
    for (let box = heading.parentElement; box !== null; box = box.parentElement) box.scrollTop = 0;
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
})();
