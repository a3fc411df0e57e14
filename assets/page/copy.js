// Buttons that copy the code beside them, and cards that press the button above them.
(() => {
  "use strict";

  async function copy(button) {
    const code = button.parentElement.querySelector("code");
    try {
      await navigator.clipboard.writeText(code.textContent);
    } catch {  // not allowed without https: then it is at least selected, for the user to copy
      getSelection().selectAllChildren(code);
      document.execCommand("copy");
    }
    button.textContent = button.dataset.copy;
  }

  document.addEventListener("click", (event) => {
    if (!(event.target instanceof Element)) return;
    const button = event.target.closest("[data-copy]");
    if (button !== null) copy(button);
    event.target.closest("[data-card]")?.parentElement.previousElementSibling?.querySelector("button")?.click();
  });
})();
