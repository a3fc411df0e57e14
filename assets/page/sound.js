// Plays the distances from the path as two tones, from [data-tones]: the left robot's in the left ear,
// the right one's in the right. A tone rises by an octave in 25 mm, and is silent while the lab is paused.
(() => {
  "use strict";

  const LOW = 220, OCTAVE = 25;  // [Hz], [mm]
  const LOUD = 0.08, SOON = 0.06;  // [s]
  let context = null, voices = [];

  function begin() {
    context = new AudioContext();
    voices = [-1, 1].map((side) => {
      const tone = context.createOscillator(), gain = context.createGain();
      const pan = context.createStereoPanner();
      gain.gain.value = 0;
      pan.pan.value = side;
      tone.connect(gain).connect(pan).connect(context.destination);
      tone.start();
      return { tone, gain };
    });
  }

  // Browsers allow sound only after the user has pressed something on the page.
  function wake() {
    if (context?.state === "suspended") context.resume();
  }

  function look() {
    const said = document.querySelector("[data-tones]")?.dataset;
    const on = said !== undefined && said.tones !== "";
    if (!on && context === null) return;
    if (context === null) begin();
    wake();
    const distances = on ? said.tones.split(" ").map(Number) : [];
    voices.forEach(({ tone, gain }, index) => {
      const loud = on && said.running === "yes" ? LOUD : 0;
      gain.gain.setTargetAtTime(loud, context.currentTime, SOON);
      if (!Number.isFinite(distances[index])) return;
      const pitch = LOW * 2 ** Math.min(distances[index] / OCTAVE, 4);
      tone.frequency.setTargetAtTime(pitch, context.currentTime, SOON);
    });
  }

  for (const press of ["pointerdown", "keydown"]) addEventListener(press, wake, { capture: true });
  new MutationObserver(look).observe(document, { childList: true, subtree: true });
})();
