// Numbers and small parts of the page.
carom.format = (() => {
  const SUPERSCRIPT = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

  function number(value, digits = 4) {
    if (value === null || value === undefined || Number.isNaN(value)) return "–";
    if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e-3 && size < 1e5) {
      return String(Number(value.toPrecision(digits))).replace("-", "−");
    }
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    const power = [...String(Number(exponent))].map((c) => SUPERSCRIPT[c]).join("");
    const factor = Number(mantissa);
    if (Math.abs(factor) === 1) return `${factor < 0 ? "−" : ""}10${power}`;
    return `${String(factor).replace("-", "−")}\u202f×\u202f10${power}`;
  }
  function quantity(value, unit, digits) {
    return unit ? `${number(value, digits)}\u202f${unit}` : number(value, digits);
  }
  // Times are told in one unit throughout, which Python has chosen by the length of the run.
  const clockUnit = { symbol: "s", seconds: 1 };
  const inUnit = (time, digits) => number(time / clockUnit.seconds, digits);
  const time = (value, digits) => `${inUnit(value, digits)}\u202f${clockUnit.symbol}`;
  function create(tag, properties = {}, ...children) {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  }
  function options(select, entries) {
    select.replaceChildren(...entries.map(([value, text]) => create("option", { value, textContent: text })));
  }
  return { number, quantity, time, inUnit, clockUnit, create, options };
})();
