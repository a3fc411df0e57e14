// What the page says before the lab has sent any texts, in the browser's language.
const ownWords = (() => {
  "use strict";

  const texts = JSON.parse(document.getElementById("op-words").textContent);
  const own = navigator.languages.map((language) => language.split("-")[0]);
  const language = own.find((each) => each in texts) ?? "en";
  return { language, text: texts[language] };
})();
