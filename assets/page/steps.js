// A step of a lesson opens at its top: left alone, its panel stays scrolled as the step before was.
(() => {
  "use strict";

  let shown = "";

  function look() {
    const heading = document.querySelector("[data-step]");
    if (heading === null || heading.dataset.step === shown) return;
    shown = heading.dataset.step;
    for (let box = heading.parentElement; box !== null; box = box.parentElement) box.scrollTop = 0;
  }

  new MutationObserver(look).observe(document, { childList: true, subtree: true });
})();
