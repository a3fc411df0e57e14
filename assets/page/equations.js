// An equation that is wider than its panel is made smaller until it fits; not so small that it
// cannot be read: then it can be scrolled.
(() => {
  "use strict";

  const LEAST = 0.7;  // of its size

  function fit(equation) {
    equation.style.fontSize = "";
    const share = equation.clientWidth / equation.scrollWidth;
    if (share >= 1 || equation.clientWidth === 0) return;
    const size = parseFloat(getComputedStyle(equation).fontSize);
    equation.style.fontSize = `${Math.max(share * 0.98, LEAST) * size}px`;
  }

  const widths = new ResizeObserver((changes) => changes.forEach(({ target }) => {
    const width = target.parentElement?.clientWidth;
    if (width === widthOf.get(target)) return;  // its own size has changed
    widthOf.set(target, width);
    fit(target);
  }));
  const widthOf = new WeakMap();

  new MutationObserver(() => {
    for (const equation of document.querySelectorAll('math[display="block"]:not([data-fits])')) {
      equation.dataset.fits = "";
      widths.observe(equation);
    }
  }).observe(document, { childList: true, subtree: true });
})();
