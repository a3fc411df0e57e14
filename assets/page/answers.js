// Lets users press the answers of a question directly. A press is passed on to the button with the
// answer's letter, in the row after the question, which style.css hides.
(() => {
  "use strict";

  const ANSWER = "[data-answer]";

  document.addEventListener("click", (event) => {
    const answer = event.target instanceof Element ? event.target.closest(ANSWER) : null;
    const question = answer?.parentElement;
    const row = question?.parentElement.nextElementSibling?.querySelectorAll("button") ?? [];
    [...row].find((each) => each.textContent === answer.dataset.answer)?.click();
    for (const each of question?.querySelectorAll(ANSWER) ?? []) {
      each.setAttribute("aria-pressed", String(each === answer));
    }
  });
})();
