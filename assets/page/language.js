// viser formats numbers in the browser's language and draws nothing if that is no valid tag: WebKit
// reports the language of a system without one as "C".
(() => {
  "use strict";

  try {
    Intl.getCanonicalLocales(navigator.language);
  } catch {
    Object.defineProperty(navigator, "language", { value: "en" });
    Object.defineProperty(navigator, "languages", { value: ["en"] });
  }
})();
