// Shrinks an equation that is wider than its panel until it fits, but not so far that it becomes
// illegible; then it can be scrolled.
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
