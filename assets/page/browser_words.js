// What the page says when the lab sends no texts, in the page's language, or else in the browser's.
const ownWords = (() => {
  "use strict";

  const texts = JSON.parse(document.getElementById("op-words").textContent);

  function language() {
    const { lang, classList } = document.documentElement;
    const shown = classList.contains("op-loading") ? [] : [lang];
    const own = [...shown, ...navigator.languages].map((each) => each.split("-")[0]);
    return own.find((each) => each in texts) ?? "en";
  }

  return { language, text: () => texts[language()] };
})();
