// The colours and what they stand for.
carom.colourBar = (() => {
  const bar = document.getElementById("colour-bar");
  const context = bar.querySelector("canvas").getContext("2d");
  const TICKS = matchMedia("(max-width: 760px)").matches ? 3 : 5;

  function show(field, limits, map) {
    context.putImageData(new ImageData(new Uint8ClampedArray(map.bytes), 256, 1), 0, 0);
    const ticks = Array.from({ length: TICKS }, (_, i) => {
      const share = i / (TICKS - 1);
      const text = carom.format.number(limits.low + share * (limits.high - limits.low), 3);
      const tick = carom.format.create("span", { textContent: text });
      tick.style.left = `${100 * share}%`;
      return tick;
    });
    bar.querySelector(".ticks").replaceChildren(...ticks);
    const title = field.unit ? `${field.title} [${field.unit}]` : field.title;
    document.getElementById("colour-title").textContent = title;
    const { quantity } = carom.format;
    bar.setAttribute("aria-label", `${title} from ${quantity(limits.low, field.unit, 3)} to ${quantity(limits.high, field.unit, 3)}`);
  }
  return { show };
})();
