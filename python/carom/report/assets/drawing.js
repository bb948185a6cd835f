// A chart as a drawing of its own, for files and for paper: lines that stay sharp at any size.
carom.drawing = (() => {
  const { create, number, inUnit } = carom.format;
  const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
  const LETTER = 6.6; // mean width of a letter of 12 px
  const MARKUP = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };
  const escaped = (text) => String(text).replace(/[&<>"]/g, (character) => MARKUP[character]);

  // Round numbers within an axis, about so many.
  function ticks(low, high, count) {
    const raw = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(raw));
    const stride = power * [1, 2, 5, 10].find((factor) => factor * power >= raw * (1 - 1e-9));
    const found = [];
    for (let k = Math.ceil(low / stride - 1e-9); k * stride <= high + 1e-9 * stride; k++) found.push(k * stride);
    return found;
  }
  function decades(low, high) {
    const [first, last] = [Math.ceil(Math.log10(low)), Math.floor(Math.log10(high))];
    const stride = Math.max(1, Math.ceil((last - first + 1) / 5));
    const found = [];
    for (let power = first; power <= last; power += stride) found.push(Number(`1e${power}`));
    return found;
  }

  // The points of a curve that can be told apart at a tenth of a pixel.
  function path(times, values, x, y, steps, [low, high]) {
    let text = "";
    let pen = false;
    let last = "";
    for (let i = 0; i < times.length; i++) {
      const outside = (times[i + 1] ?? times[i]) < low || (times[i - 1] ?? times[i]) > high;
      if (values[i] === null || outside) {
        pen = false;
        continue;
      }
      const [left, top] = [x(times[i]).toFixed(1), y(values[i]).toFixed(1)];
      const here = `${left} ${top}`;
      if (pen && here === last) continue;
      text += pen ? (steps ? `V${top}H${left}` : `L${here}`) : `M${here}`;
      [pen, last] = [true, here];
    }
    return text;
  }

  // `curves`: label, colour, dash and values over `times`; `x` and `y`: the ends of the axes.
  function svg({ title, unit, log, steps, curves, times, x: [left, right], y: [low, high], width = 720, height = 300 }) {
    const colour = (name) => carom.theme.colour(name);
    const labels = curves.map((curve) => ({ ...curve, wide: 30 + LETTER * curve.label.length }));
    const rows = [];
    let free = 0;
    for (const label of labels) {
      if (label.wide > free) {
        rows.push([]);
        free = width - 20;
      }
      rows.at(-1).push(label);
      free -= label.wide;
    }
    const across = ticks(left, right, 6);
    const up = log ? decades(low, high) : ticks(low, high, height > 220 ? 6 : 4);
    const written = up.map((value) => number(value, 6));
    const box = {
      left: 16 + LETTER * Math.max(...written.map((text) => text.length), 3),
      right: width - 20,
      top: 34 + 18 * rows.length,
      bottom: height - 40,
    };
    const scale = (value) => (log ? Math.log10(value) : value);
    const x = (time) => box.left + ((time - left) / (right - left || 1)) * (box.right - box.left);
    const y = (value) => box.bottom - ((scale(value) - scale(low)) / (scale(high) - scale(low) || 1)) * (box.bottom - box.top);
    const parts = [`<rect width="${width}" height="${height}" fill="${colour("card")}"/>`];
    const say = (text, at, options = "") => parts.push(`<text x="${at[0].toFixed(1)}" y="${at[1].toFixed(1)}" ${options}>${escaped(text)}</text>`);
    const faint = `fill="${colour("faint")}"`;
    say(unit ? `${title} [${unit}]` : title, [10, 20], `font-weight="600" font-size="14" fill="${colour("ink")}"`);
    rows.forEach((row, index) => {
      let start = 10;
      for (const { label, wide, colour: name, dash } of row) {
        const middle = 34 + 18 * index;
        parts.push(`<path d="M${start} ${middle}h18" stroke="${colour(name)}" stroke-width="2"${dashed(dash)}/>`);
        say(label, [start + 23, middle + 4], `fill="${colour("ink")}"`);
        start += wide;
      }
    });
    for (const time of across) {
      parts.push(`<path d="M${x(time).toFixed(1)} ${box.top}V${box.bottom}" stroke="${colour("line")}"/>`);
      say(inUnit(time, 6), [x(time), box.bottom + 16], `text-anchor="middle" ${faint}`);
    }
    up.forEach((value, index) => {
      parts.push(`<path d="M${box.left.toFixed(1)} ${y(value).toFixed(1)}H${box.right}" stroke="${colour("line")}"/>`);
      say(written[index], [box.left - 6, y(value) + 4], `text-anchor="end" ${faint}`);
    });
    say(`time [${carom.format.clockUnit.symbol}]`, [(box.left + box.right) / 2, height - 8], `text-anchor="middle" ${faint}`);
    const clip = `clip${Math.random().toString(36).slice(2)}`; // drawings of a page share their names
    parts.push(`<clipPath id="${clip}"><rect x="${box.left}" y="${box.top - 1}" width="${box.right - box.left}" height="${box.bottom - box.top + 2}"/></clipPath>`);
    const drawn = curves.map((curve) => (
      `<path d="${path(times, curve.values, x, y, steps, [left, right])}" stroke="${colour(curve.colour)}" stroke-width="1.6" stroke-linejoin="round"${dashed(curve.dash)}/>`
    ));
    parts.push(`<g clip-path="url(#${clip})">${drawn.join("")}</g>`);
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" fill="none" font-family="${FONT}" font-size="12">${parts.join("")}</svg>`;
  }
  const dashed = (dash) => (dash ? ` stroke-dasharray="${dash.join(" ")}"` : "");

  // A drawing as an element of the page.
  const element = (text) => document.importNode(new DOMParser().parseFromString(text, "image/svg+xml").documentElement, true);

  // A drawing in pixels, three for each of its own.
  async function canvas(text, scale = 3) {
    const image = new Image();
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
    await image.decode();
    const made = create("canvas", { width: image.width * scale, height: image.height * scale });
    made.getContext("2d").drawImage(image, 0, 0, made.width, made.height);
    return made;
  }
  return { svg, element, canvas };
})();
